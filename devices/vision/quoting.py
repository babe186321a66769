"""Words of strangers as data: on one line, in quotation marks, of bounded length, without characters that hide things."""

import json
import unicodedata


def quoted(text: str, most: int) -> str:
    """As a JSON string of at most `most` characters between its marks; what is left out is shown by three dots."""
    plain = " ".join("".join(c if unicodedata.category(c)[0] != "C" else " " for c in text[: 8 * most]).split())
    if len(plain) > most:
        plain = f"{plain[: most - 3].rstrip()}..."
    return json.dumps(plain, ensure_ascii=False)
