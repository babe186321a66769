"""The shaders: instanced shapes lit by their room's lamp, and the id of each pixel's owner.

Things are lit at their corners, which is cheap; the large faces of the building are lit at every pixel.
"""

from sim.render.lamps import PLACES
from sim.render.view import BUILDING, BUILDING_PICTURED, SOFT_SHADOW, THING, THING_PICTURED
from sim.textures import BOARD, LAYERS

_LIGHT = """
uniform float ceiling_m;

// Darker where two surfaces of the room meet; the distance along the surface's own normal does not count.
float corner_light(vec3 at, vec3 n, vec4 extent) {
    vec3 gap = vec3(min(at.x - extent.x, extent.z - at.x), min(at.y - extent.y, extent.w - at.y),
                    min(at.z, ceiling_m - at.z));
    vec3 open = clamp((max(gap, 0.0) + 0.03) / (0.45 * (1.02 - abs(n))), 0.0, 1.0);
    return 0.68 + 0.32 * open.x * open.y * (0.4 + 0.6 * open.z);
}

vec3 light(vec3 at, vec3 n, vec4 lamp, vec4 extent) {
    vec3 to_lamp = lamp.xyz - at;
    float direct = max(dot(n, to_lamp), 0.0) / (1.0 + 0.45 * dot(to_lamp, to_lamp));
    float window = max(dot(n, vec3(0.48, -0.60, 0.64)), 0.0);
    float ambient = 0.54 + 0.06 * n.z + 0.05 * n.x - 0.03 * n.y + 0.10 * max(-n.z, 0.0);
    vec3 warm = mix(vec3(1.0), vec3(1.10, 0.98, 0.80), lamp.w);
    return (vec3(ambient) + 0.56 * direct * warm + 0.13 * window) * corner_light(at, n, extent);
}
"""

_VERTEX = f"""
uniform mat4 clip_from_site;
uniform float repeat_m[{LAYERS}];          // 0: one picture over the whole face
uniform vec4 lamps[{PLACES}];        // position and warmth, by room; the last one for no room
uniform vec4 extents[{PLACES}];      // x and y of the room's bounding box
in vec3 position; in vec3 normal; in vec2 uv; in vec3 along_u; in vec3 along_v;
in vec3 axis_x; in vec3 axis_y; in vec3 axis_z; in vec3 centre;
in vec3 rgb; in float surface; in float emission; in float room; in int owner;
out vec3 colour; out vec2 picture; flat out float layer; flat out int pixel_owner;
#ifdef PER_PIXEL
out vec3 world; flat out vec3 facing; flat out vec4 lamp; flat out vec4 extent;
#endif

void main() {{
    vec3 at = centre + position.x * axis_x + position.y * axis_y + position.z * axis_z;
    gl_Position = clip_from_site * vec4(at, 1.0);
    vec3 squared = vec3(dot(axis_x, axis_x), dot(axis_y, axis_y), dot(axis_z, axis_z));
    vec3 n = normalize(normal.x / squared.x * axis_x + normal.y / squared.y * axis_y + normal.z / squared.z * axis_z);
    vec3 size = sqrt(squared);
    float repeat = repeat_m[int(surface)];
    bool on_plan = along_u == vec3(0.0);
    vec2 span = vec2(dot(along_u, size), dot(along_v, size));
    vec2 metres = on_plan ? at.xy : uv * span;
#ifdef STRETCHED
    repeat = 0.0;
#endif
    picture = repeat == 0.0 ? uv : metres / repeat;
    if (surface == float({BOARD}) && span.y > span.x) picture = picture.yx;
    layer = surface;
    pixel_owner = owner + 1;         // 0 is what a cleared picture holds: nothing
    int place = room < 0.0 ? {PLACES - 1} : int(room);
#ifdef PER_PIXEL
    world = at; facing = n; lamp = lamps[place]; extent = extents[place]; colour = rgb;
#else
    colour = rgb * mix(light(at, n, lamps[place], extents[place]), vec3(1.0), emission);
#endif
}}
"""

_FRAGMENT = """
in vec3 colour; in vec2 picture; flat in float layer; flat in int pixel_owner;
layout(location = 0) out vec4 out_rgb;
layout(location = 1) out int out_owner;
#ifdef PER_PIXEL
in vec3 world; flat in vec3 facing; flat in vec4 lamp; flat in vec4 extent;
#endif
#ifdef TEXTURED
uniform sampler2DArray surfaces;
#endif

void main() {
    vec3 seen = colour;
#ifdef TEXTURED
    seen *= texture(surfaces, vec3(picture, layer)).rgb;
#endif
#ifdef PER_PIXEL
    // A skirting board along the foot of every wall.
    if (world.z < 0.08 && abs(facing.z) < 0.5) seen = vec3(world.z < 0.07 ? 0.90 : 0.70);
    seen *= light(world, facing, lamp, extent);
#endif
    out_rgb = vec4(seen, 1.0);
    out_owner = pixel_owner;
}
"""


_SOFT = """
in vec2 picture;
layout(location = 0) out vec4 out_rgb;

void main() {
    vec2 edge = 1.0 - abs(2.0 * picture - 1.0);
    vec2 dark = clamp(edge * 3.0, 0.0, 1.0);
    out_rgb = vec4(0.0, 0.0, 0.0, 0.42 * dark.x * dark.y);
}
"""
_SWITCHES = {
    THING: "",
    THING_PICTURED: "#define TEXTURED\n",
    BUILDING: "#define PER_PIXEL\n",
    BUILDING_PICTURED: "#define PER_PIXEL\n#define TEXTURED\n",
    SOFT_SHADOW: "#define STRETCHED\n",
}


def sources(way: int) -> tuple[str, str]:
    """Vertex and fragment shader for one of `view.WAYS`."""
    head = f"#version 330\n{_SWITCHES[way]}{_LIGHT}"
    return head + _VERTEX, head + (_SOFT if way == SOFT_SHADOW else _FRAGMENT)
