"""The two shaders: instanced shapes lit by their room's lamp, and the id of each pixel's owner."""

VERTEX = """
#version 330
const float STRETCHED = 0.0;
uniform mat4 clip_from_site;
uniform float repeat_m[12];
uniform vec4 lamps[65];        // position and warmth, by room; the last one for no room
uniform vec4 extents[65];      // x and y of the room's bounding box
in vec3 position; in vec3 normal; in vec2 uv; in vec3 along_u; in vec3 along_v;
in vec3 axis_x; in vec3 axis_y; in vec3 axis_z; in vec3 centre;
in vec3 rgb; in float surface; in float emission; in float room; in int owner;
out vec3 world; out vec3 facing; out vec2 picture;
flat out vec3 colour; flat out float layer; flat out float glow; flat out vec4 lamp; flat out vec4 extent;
flat out int pixel_owner;

void main() {
    world = centre + position.x * axis_x + position.y * axis_y + position.z * axis_z;
    vec3 squared = vec3(dot(axis_x, axis_x), dot(axis_y, axis_y), dot(axis_z, axis_z));
    facing = normal.x / squared.x * axis_x + normal.y / squared.y * axis_y + normal.z / squared.z * axis_z;
    vec3 size = sqrt(squared);
    float repeat = repeat_m[int(surface)];
    bool on_plan = along_u == vec3(0.0);
    vec2 metres = on_plan ? world.xy : uv * vec2(dot(along_u, size), dot(along_v, size));
    picture = repeat == STRETCHED ? uv : metres / repeat;
    int place = room < 0.0 ? 64 : int(room);
    lamp = lamps[place];
    extent = extents[place];
    colour = rgb;
    layer = surface;
    glow = emission;
    pixel_owner = owner;
    gl_Position = clip_from_site * vec4(world, 1.0);
}
"""

FRAGMENT = """
#version 330
uniform sampler2DArray surfaces;
uniform float ceiling_m;
in vec3 world; in vec3 facing; in vec2 picture;
flat in vec3 colour; flat in float layer; flat in float glow; flat in vec4 lamp; flat in vec4 extent;
flat in int pixel_owner;
layout(location = 0) out vec4 out_rgb;
layout(location = 1) out int out_owner;

// Darker where two surfaces of the room meet; the distance along the surface's own normal does not count.
float corner_light(vec3 n) {
    vec3 gap = vec3(min(world.x - extent.x, extent.z - world.x), min(world.y - extent.y, extent.w - world.y),
                    min(world.z, ceiling_m - world.z));
    vec3 open = clamp((max(gap, 0.0) + 0.02) / (0.45 * (1.02 - abs(n))), 0.0, 1.0);
    return 0.62 + 0.38 * open.x * open.y * (0.4 + 0.6 * open.z);
}

void main() {
    vec3 n = normalize(facing);
    vec3 to_lamp = lamp.xyz - world;
    float squared = dot(to_lamp, to_lamp);
    float direct = max(dot(n, to_lamp), 0.0) * inversesqrt(squared) / (1.0 + 0.035 * squared);
    float window = max(dot(n, vec3(0.48, -0.60, 0.64)), 0.0);
    float ambient = 0.46 + 0.10 * n.z + 0.04 * n.x;
    vec3 warm = mix(vec3(1.0), vec3(1.08, 0.99, 0.84), lamp.w);
    vec3 light = (vec3(ambient) + 0.55 * direct * warm + 0.16 * window) * corner_light(n);
    vec3 base = colour * SAMPLE;
    out_rgb = vec4(mix(base * light, base, glow), 1.0);
    out_owner = pixel_owner + 1;    // 0 is what a cleared picture holds: nothing
}
"""

TEXTURED = FRAGMENT.replace("SAMPLE", "texture(surfaces, vec3(picture, layer)).rgb")
PLAIN = FRAGMENT.replace("SAMPLE", "1.0")
