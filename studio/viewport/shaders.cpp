#include <studio/viewport/shaders.hpp>

namespace weave::studio::shaders {

namespace {

/// The camera of camera.hpp, its axes right, up, away.
constexpr const char* camera = R"(
uniform samplerBuffer u_knots;   // two texels each: place, radius; direction, value
uniform usamplerBuffer u_pieces; // from, to, yarn, flags
uniform usamplerBuffer u_yarns;  // colour and state, first knot, last knot
uniform vec3 u_right, u_up, u_away, u_centre;
uniform float u_distance; // of the eye; 0: no perspective
uniform vec2 u_half;      // of the picture at the centre, mm
uniform vec2 u_range;     // nearest depth, and 1 / (farthest - nearest)
uniform vec2 u_pixel;     // 2 / size in pixels
uniform vec4 u_clip;      // normal in the camera's axes, height

vec3 turned(vec3 way) { return vec3(dot(way, u_right), dot(way, u_up), dot(way, u_away)); }
vec3 to_camera(vec3 place) { return turned(place - u_centre) + vec3(0.0, 0.0, u_distance); }

void sight(vec2 pixel, out vec3 origin, out vec3 way) {
    vec2 at = (pixel * u_pixel - 1.0) * u_half;
    if (u_distance > 0.0) {
        origin = vec3(0.0);
        way = normalize(vec3(at, u_distance));
    } else {
        origin = vec3(at, 0.0);
        way = vec3(0.0, 0.0, 1.0);
    }
}
)";

constexpr const char* vertex_source = R"(
flat out vec4 v_from;
flat out vec3 v_to;
flat out uvec3 v_piece; // its number, its yarn, its flags

void main() {
    int number = gl_VertexID >> 2, corner = gl_VertexID & 3;
    uvec4 piece = texelFetch(u_pieces, number);
    vec4 start = texelFetch(u_knots, int(2u * piece.x));
    vec3 from = to_camera(start.xyz), to = to_camera(texelFetch(u_knots, int(2u * piece.y)).xyz);
    v_from = vec4(from, start.w);
    v_to = to;
    v_piece = uvec3(uint(number), piece.z, piece.w);
    vec2 a = from.xy, b = to.xy;
    float room_a = start.w, room_b = start.w;
    if (u_distance > 0.0) {
        float nearest = min(from.z, to.z) - start.w;
        if (nearest < 0.02 * u_distance) { // at the eye or behind it
            gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
            return;
        }
        float grow_a = u_distance / from.z, grow_b = u_distance / to.z;
        room_a *= grow_a * sqrt(1.0 + dot(a, a) / (from.z * from.z)) * from.z / (from.z - start.w);
        room_b *= grow_b * sqrt(1.0 + dot(b, b) / (to.z * to.z)) * to.z / (to.z - start.w);
        a *= grow_a;
        b *= grow_b;
    }
    vec2 along = b - a;
    float reach = length(along);
    along = reach > 1e-6 * start.w ? along / reach : vec2(1.0, 0.0);
    float wide = max(room_a, room_b);
    vec2 end = (corner & 1) == 0 ? a - along * room_a : b + along * room_b;
    vec2 at = end + vec2(-along.y, along.x) * ((corner & 2) == 0 ? -wide : wide);
    gl_Position = vec4(at / u_half, 0.0, 1.0);
}
)";

constexpr const char* find_source = R"(
uniform uint u_copy;
flat in vec4 v_from;
flat in vec3 v_to;
flat in uvec3 v_piece;
out uvec2 o_seen; // 1 + the piece; repeat and yarn

// The part of the ray within the piece, as within() in tube_piece.cpp; counted from the place of the ray nearest to the
// piece, numbers stay small and precise.
vec2 within(vec3 origin, vec3 way) {
    vec3 axis = v_to - v_from.xyz;
    float length2 = dot(axis, axis), radius2 = v_from.w * v_from.w;
    float foot = dot(way, v_from.xyz - origin);
    vec3 offset = origin + foot * way - v_from.xyz;
    float along = dot(axis, way), start = dot(axis, offset);
    float a = max(length2 - along * along, 1e-9 * length2);
    float b = -start * along, c = length2 * (dot(offset, offset) - radius2) - start * start;
    float depth = b * b - a * c;
    if (depth <= 0.0) discard;
    float root = sqrt(depth);
    vec2 t = vec2(-b - root, -b + root) / a;
    vec2 height = start + t * along;
    // Beyond an end, the ball there.
    vec2 inside = clamp(height, 0.0, length2);
    vec3 to_far = v_to - origin - foot * way; // from the foot to the far end
    vec2 middle = vec2(height.x < 0.5 * length2 ? -dot(offset, way) : dot(to_far, way),
                       height.y < 0.5 * length2 ? -dot(offset, way) : dot(to_far, way));
    float near2 = radius2 - (dot(offset, offset) - dot(offset, way) * dot(offset, way));
    float far2 = radius2 - (dot(to_far, to_far) - dot(to_far, way) * dot(to_far, way));
    vec2 ball = vec2(height.x < 0.5 * length2 ? near2 : far2, height.y < 0.5 * length2 ? near2 : far2);
    if (height.x != inside.x) {
        if (ball.x <= 0.0) discard;
        t.x = middle.x - sqrt(ball.x);
    }
    if (height.y != inside.y) t.y = middle.y + sqrt(max(ball.y, 0.0));
    return t + foot;
}

#ifdef PLANES
void keep(vec3 normal, float height, vec3 origin, vec3 way, inout vec2 t) {
    float slope = dot(normal, way), above = dot(normal, origin) - height;
    if (abs(slope) < 1e-6) {
        if (above > 0.0) t = vec2(0.0);
    } else if (slope > 0.0) {
        t.y = min(t.y, -above / slope);
    } else {
        t.x = max(t.x, -above / slope);
    }
}

void keep_end(uint knot, float side, vec3 origin, vec3 way, inout vec2 t) {
    vec3 normal = side * turned(texelFetch(u_knots, int(2u * knot + 1u)).xyz);
    keep(normal, dot(normal, to_camera(texelFetch(u_knots, int(2u * knot)).xyz)), origin, way, t);
}
#endif

void main() {
    vec3 origin, way;
    sight(gl_FragCoord.xy, origin, way);
    vec2 t = within(origin, way);
    float depth_in = 0.0;
#ifdef PLANES
    float round_at = t.x;
    if (v_piece.z != 0u) {
        uvec4 yarn = texelFetch(u_yarns, int(v_piece.y));
        if ((v_piece.z & 1u) != 0u) keep_end(yarn.y, -1.0, origin, way, t);
        if ((v_piece.z & 2u) != 0u) keep_end(yarn.z, 1.0, origin, way, t);
    }
    if (dot(u_clip.xyz, u_clip.xyz) > 0.0) keep(u_clip.xyz, u_clip.w, origin, way, t);
    if (t.x >= t.y) discard;
    if (t.x > round_at) { // where two pieces are cut at one place, the one whose axis is nearer is seen
        vec3 axis = v_to - v_from.xyz, out_way = origin + t.x * way - v_from.xyz;
        out_way -= clamp(dot(out_way, axis) / max(dot(axis, axis), 1e-20), 0.0, 1.0) * axis;
        depth_in = 1e-5 * length(out_way) / v_from.w;
    }
#endif
    gl_FragDepth = clamp((origin.z + t.x * way.z - u_range.x) * u_range.y + depth_in, 0.0, 1.0);
    o_seen = uvec2(v_piece.x + 1u, u_copy | (v_piece.y << 8));
}
)";

constexpr const char* whole_source = R"(
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

constexpr const char* light_source = R"(
uniform usampler2D u_seen;
uniform sampler2D u_depth;
uniform sampler2D u_map;
uniform vec3 u_top, u_bottom;     // the ground
uniform vec3 u_mark;              // round emphasised yarns
uniform vec2 u_values;            // low, and 1 / (high - low); the second 0: yarns have their own colours
uniform vec3 u_period_x, u_period_y; // from one repeat to the next, in the camera's axes
uniform float u_dim;              // how much of the ground shows in dimmed yarns
uniform float u_reach;            // within which yarns take light from one another, pixels
uniform float u_mark_width;       // pixels
out vec4 o_colour;

const uint dimmed = 1u, hovered = 2u, selected = 4u;
const ivec2 around[8] = ivec2[8](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1), ivec2(1, 1), ivec2(-1, 1), ivec2(1, -1),
                                 ivec2(-1, -1));

vec3 ground(vec2 pixel) { return mix(u_bottom, u_top, clamp(0.5 * u_pixel.y * pixel.y, 0.0, 1.0)); }

vec3 place_of(vec2 pixel, float depth) {
    vec3 origin, way;
    sight(pixel, origin, way);
    float away = depth / u_range.y + u_range.x;
    return origin + way * ((away - origin.z) / way.z);
}

uint state_of(uvec2 seen) { return seen.x == 0u ? 0u : texelFetch(u_yarns, int(seen.y >> 8)).x >> 24; }

#ifdef HOLLOWS
// Depths around tell how much of the sky other yarns take.
float hidden(vec2 pixel, vec3 place, vec3 normal, float radius) {
    const int looks = 20;
    float sum = 0.0;
    ivec2 last = textureSize(u_depth, 0) - 1;
    // A spiral of golden angles; neighbouring pixels begin it at other angles, so that no outline is seen twice.
    int order = (int(pixel.x) & 1) + 2 * ((int(pixel.x) + int(pixel.y)) & 1);
    float first = 0.3 * float(order);
    vec2 spoke = vec2(cos(first), sin(first));
    const mat2 turn = mat2(-0.737369, 0.675490, -0.675490, -0.737369);
    for (int k = 0; k < looks; ++k) {
        vec2 at = pixel + spoke * (u_reach * sqrt((float(k) + 0.7) / float(looks)));
        spoke = turn * spoke;
        ivec2 texel = clamp(ivec2(at), ivec2(0), last);
        vec3 to = place_of(vec2(texel) + 0.5, texelFetch(u_depth, texel, 0).x) - place;
        float far2 = dot(to, to);
        sum += max(0.0, dot(to, normal) * inversesqrt(far2 + 1e-12) - 0.12) / (1.0 + far2 / (6.0 * radius * radius));
    }
    return sum / float(looks);
}
#endif

// As shaded() in tube_shade.cpp.
vec3 lit(vec3 colour, vec3 normal, vec3 way, float open) {
    const vec3 lamp = vec3(-0.4234, 0.6855, -0.6049);
    float facing = max(0.0, -dot(normal, way)), edge = min(1.0, facing / 0.45), rim = edge * (2.0 - edge);
    float side = max(0.0, (dot(normal, lamp) + 0.3) / 1.3);
    float gleam = max(0.0, dot(normal, normalize(lamp - way)));
    gleam *= gleam;
    gleam *= gleam;
    gleam *= gleam;
    gleam = gleam * gleam * gleam * gleam * 0.06 * open;
    if (u_values.y > 0.0)
        return colour * ((0.42 + 0.62 * side * open) * (0.45 + 0.55 * open) * (0.6 + 0.4 * rim) + 0.08) + gleam;
    float amount = (0.42 + 0.08 * normal.y) * open + 0.74 * side * sqrt(open) * (0.3 + 0.7 * open);
    return colour * amount * (0.5 + 0.5 * rim) + gleam;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    uvec2 seen = texelFetch(u_seen, texel, 0).xy;
    vec3 behind = ground(gl_FragCoord.xy);
    vec3 colour = behind;
    uint state = 0u;
    if (seen.x != 0u) {
        vec3 place = place_of(gl_FragCoord.xy, texelFetch(u_depth, texel, 0).x);
        uvec4 piece = texelFetch(u_pieces, int(seen.x - 1u));
        vec4 start = texelFetch(u_knots, int(2u * piece.x)), stop = texelFetch(u_knots, int(2u * piece.y));
        vec4 start_way = texelFetch(u_knots, int(2u * piece.x + 1u)), stop_way = texelFetch(u_knots, int(2u * piece.y + 1u));
        uint word = texelFetch(u_yarns, int(piece.z)).x;
        state = word >> 24;
        vec3 from = to_camera(start.xyz) + float(seen.y & 15u) * u_period_x + float((seen.y >> 4) & 15u) * u_period_y;
        vec3 axis = turned(stop.xyz - start.xyz);
        vec3 out_way = place - from;
        float share = clamp(dot(out_way, axis) / max(dot(axis, axis), 1e-20), 0.0, 1.0);
        out_way -= share * axis;
        float out_share = length(out_way) / start.w;

        vec3 own = vec3(float(word & 255u), float((word >> 8) & 255u), float((word >> 16) & 255u)) / 255.0;
        if (u_values.y > 0.0) {
            float value = (mix(start_way.w, stop_way.w, share) - u_values.x) * u_values.y;
            own = texture(u_map, vec2(clamp(value, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
        }
        own *= own; // light, nearly
        if ((state & (hovered | selected)) != 0u) own = mix(own, vec3(1.0), (state & hovered) != 0u ? 0.3 : 0.15);
        vec3 light;
        if (out_share < 0.96) { // inside the yarn: it is cut
            bool by_plane = abs(dot(u_clip.xyz, place) - u_clip.w) < 0.02 * start.w && dot(u_clip.xyz, u_clip.xyz) > 0.0;
            float radius_px = start.w / (u_half.y * u_pixel.y);
            if (by_plane) {
                vec2 stripe = gl_FragCoord.xy / max(3.0, 0.42 * radius_px);
                bool is_hatch = radius_px > 6.0 && fract(stripe.x + stripe.y) < 0.28;
                light = mix(own, vec3(1.0), 0.42);
                if (is_hatch) light = own * 0.55;
                if (out_share > clamp(1.0 - 1.6 / radius_px, 0.6, 0.86)) light = vec3(0.01, 0.01, 0.015);
            } else {
                light = out_share > 0.9 ? own * 0.35 : mix(own, vec3(1.0), 0.22);
            }
        } else {
            // Across the yarn's own direction, which changes evenly along a piece, so that no joints show.
            vec3 tangent = normalize(mix(turned(start_way.xyz), turned(stop_way.xyz), share));
            vec3 across = out_way - dot(out_way, tangent) * tangent;
            vec3 normal = normalize(dot(across, across) > 0.01 * start.w * start.w ? across : out_way);
            vec3 origin, way;
            sight(gl_FragCoord.xy, origin, way);
            float open = 0.9;
#ifdef HOLLOWS
            open = exp(-3.2 * hidden(gl_FragCoord.xy, place, normal, start.w));
#endif
            light = lit(own, normal, way, open);
        }
        colour = sqrt(clamp(light, 0.0, 1.0));
        if ((state & dimmed) != 0u) colour = mix(colour, behind, u_dim);
    }
#ifdef MARKED
    // A line round emphasised yarns, outside them.
    if ((state & (hovered | selected)) == 0u) {
        ivec2 last = textureSize(u_seen, 0) - 1;
        int wide = int(u_mark_width + 0.5);
        uint near = 0u;
        for (int k = 0; k < 8; ++k) {
            ivec2 at = clamp(texel + around[k] * wide, ivec2(0), last);
            uvec2 other = texelFetch(u_seen, at, 0).xy;
            near |= state_of(other);
        }
        if ((near & (hovered | selected)) != 0u) colour = u_mark;
    }
#endif
    o_colour = vec4(colour, 1.0);
}
)";

QByteArray source(std::initializer_list<const char*> defined, std::initializer_list<const char*> parts) {
    QByteArray text = "#version 330 core\n";
    for (const char* name : defined) text += QByteArray("#define ") + name + "\n";
    for (const char* part : parts) text += part;
    return text;
}

}  // namespace

QByteArray vertex(std::initializer_list<const char*> defined) {
    return source(defined, {camera, vertex_source});
}
QByteArray find(std::initializer_list<const char*> defined) {
    return source(defined, {camera, find_source});
}
QByteArray whole(std::initializer_list<const char*> defined) {
    return source(defined, {whole_source});
}
QByteArray light(std::initializer_list<const char*> defined) {
    return source(defined, {camera, light_source});
}

}  // namespace weave::studio::shaders
