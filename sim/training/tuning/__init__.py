"""Tunes a Qwen2.5-VL model on pictures with GridMask, and hands it to an Ollama server. See docs/tune-a-vision-model.md."""
