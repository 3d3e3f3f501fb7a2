#include <studio/viewport/software_finder.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <thread>

namespace weave::studio {

namespace {

constexpr int band_rows = 16, lanes = 8;
constexpr std::size_t depth_steps = 2048;

using Rod = SoftwareFinder::Rod;
using Side = SoftwareFinder::Side;

/// The camera as numbers; a pixel's ray goes through (u, v) at distance `eye`, or without perspective
/// straight from there.
struct Sight {
    float right[3], up[3], away[3], centre[3];
    float eye = 0, half_wide = 1, half_high = 1;
    float pixel_wide = 0, pixel_high = 0;  ///< mm at the centre
    float near = 0, per_depth = 1;
};

Sight sight_of(const FindTask& task) {
    Sight sight{};
    const Vec3 right = task.camera.right(), up = task.camera.up(), away = task.camera.away();
    for (int k = 0; k < 3; ++k) {
        sight.right[k] = static_cast<float>(right[k]);
        sight.up[k] = static_cast<float>(up[k]);
        sight.away[k] = static_cast<float>(away[k]);
        sight.centre[k] = static_cast<float>(task.camera.centre[k]);
    }
    sight.eye = static_cast<float>(task.camera.distance());
    sight.half_high = static_cast<float>(task.camera.height_mm / 2);
    sight.half_wide = static_cast<float>(task.camera.height_mm / 2 * task.size.width / task.size.height);
    sight.pixel_wide = 2 * sight.half_wide / static_cast<float>(task.width);
    sight.pixel_high = 2 * sight.half_high / static_cast<float>(task.height);
    sight.near = static_cast<float>(task.near);
    sight.per_depth = static_cast<float>(1 / (task.far - task.near));
    return sight;
}

float dot(const float (&a)[3], float x, float y, float z) {
    return a[0] * x + a[1] * y + a[2] * z;
}

// By value, so that loops with them become wide.
inline float larger(float a, float b) {
    return a > b ? a : b;
}
inline float smaller(float a, float b) {
    return a < b ? a : b;
}

/// One row of a piece's rectangle: depths where the ray meets it, from 0 to 1, and 2 where it passes by. With
/// perspective rays begin at the eye, which is 0; without it on the plane of the picture.
template <int side_count, bool with_eye>
WEAVE_WIDE static void meet_row(const Rod& rod, const Sight& sight, const Side* sides, float v,
                                float* __restrict depths) {
    const float fx = rod.from[0], fy = rod.from[1], fz = rod.from[2], ax = rod.axis[0], ay = rod.axis[1],
                az = rod.axis[2];
    const float radius = rod.radius, radius2 = radius * radius, length2 = rod.length2, eye = sight.eye;
    const float least_a = larger(1e-9F * length2, 1e-30F), per_length2 = 1 / larger(length2, 1e-20F);
    const float pixel_wide = sight.pixel_wide, near = sight.near, per_depth = sight.per_depth;
    const float first_u = (static_cast<float>(rod.left) + 0.5F) * pixel_wide - sight.half_wide;
    const int wide =
        (rod.right - rod.left + lanes - 1) / lanes * lanes;  // whole vectors; what is too much nobody reads
    for (int x = 0; x < wide; ++x) {
        const float u = first_u + static_cast<float>(x) * pixel_wide;
        const float slant = with_eye ? 1 / std::sqrt(u * u + v * v + eye * eye) : 0.0F;
        const float wx = u * slant, wy = v * slant, wz = with_eye ? eye * slant : 1.0F;
        const float ox = (with_eye ? 0.0F : u) - fx, oy = (with_eye ? 0.0F : v) - fy, oz = -fz;
        const float foot = -(wx * ox + wy * oy + wz * oz);
        const float px = ox + foot * wx, py = oy + foot * wy, pz = oz + foot * wz;
        const float along = ax * wx + ay * wy + az * wz, start = ax * px + ay * py + az * pz;
        const float off2 = px * px + py * py + pz * pz;
        const float a = larger(length2 - along * along, least_a), b = -start * along,
                    c = length2 * (off2 - radius2) - start * start;
        const float inner = b * b - a * c, root = std::sqrt(larger(inner, 0.0F)), per_a = 1 / a;
        const float enter = (-b - root) * per_a, height = start + enter * along;
        // Beyond an end, the ball there.
        const float near2 = radius2 - off2;
        const float qx = px - ax + along * wx, qy = py - ay + along * wy, qz = pz - az + along * wz;
        const float far2 = radius2 - (qx * qx + qy * qy + qz * qz);
        const float near_root = std::sqrt(larger(near2, 0.0F)), far_root = std::sqrt(larger(far2, 0.0F));
        const float at_near = -near_root, at_far = along - far_root;
        float t = height > length2 ? at_far : enter;
        t = height < 0 ? at_near : t;
        float ball = height > length2 ? far2 : 1.0F;
        ball = height < 0 ? near2 : ball;
        float hit = smaller(inner, ball), bias = 0;
        if constexpr (side_count > 0) {
            const float leave = (-b + root) * per_a, exit_height = start + leave * along;
            const float leave_far = along + far_root, round_at = t;
            float to = exit_height > length2 ? leave_far : leave;
            to = exit_height < 0 ? near_root : to;
            for (int k = 0; k < side_count; ++k) {
                const Side& side = sides[k];
                const float slope = side.x * wx + side.y * wy + side.z * wz;
                const float above =
                    side.x * (px + fx) + side.y * (py + fy) + side.z * (pz + fz) - side.height;
                const bool level = std::abs(slope) < 1e-6F;
                const float at = -above / (level ? 1.0F : slope);
                t = !level && slope < 0 ? larger(t, at) : t;
                to = !level && slope > 0 ? smaller(to, at) : to;
                hit = level && above > 0 ? -1.0F : hit;
            }
            hit = t < to ? hit : -1.0F;
            // Where two pieces are cut at one place, the one whose axis is nearer is seen.
            const float hx = px + t * wx, hy = py + t * wy, hz = pz + t * wz;
            const float share = smaller(larger((hx * ax + hy * ay + hz * az) * per_length2, 0.0F), 1.0F);
            const float dx = hx - share * ax, dy = hy - share * ay, dz = hz - share * az;
            const float out = 1e-5F * std::sqrt(dx * dx + dy * dy + dz * dz) / radius;
            bias = t > round_at ? out : 0.0F;
        }
        const float depth = smaller(larger(((t + foot) * wz - near) * per_depth + bias, 0.0F), 1.0F);
        depths[x] = hit > 0 ? depth : 2.0F;
    }
}

/// Whether nothing of a row lies further away than this.
WEAVE_WIDE static bool is_hidden(const float* depths, int count, float nearest) {
    float furthest = 0;
    for (int x = 0; x < count; ++x) furthest = larger(furthest, depths[x]);
    return furthest <= nearest;
}

using MeetRow = void (*)(const Rod&, const Sight&, const Side*, float, float*);

/// By the number of sides: at most the yarn's two ends and the plane that cuts.
template <bool with_eye>
constexpr std::array<MeetRow, 4> meetings{&meet_row<0, with_eye>, &meet_row<1, with_eye>,
                                          &meet_row<2, with_eye>, &meet_row<3, with_eye>};

}  // namespace

SoftwareFinder::SoftwareFinder() : m_team(std::clamp(std::thread::hardware_concurrency(), 1U, 16U) - 1) {}

void SoftwareFinder::add_rods(const TubeModel& model, const FindTask& task) {
    const Sight sight = sight_of(task);
    m_rods.clear();
    m_sides.clear();
    const auto to_side = [&](const Vec3& normal, double height) {
        const Vec3 way(normal.dot(task.camera.right()), normal.dot(task.camera.up()),
                       normal.dot(task.camera.away()));
        const double at = way.dot(task.camera.to_camera(height * normal));
        m_sides.push_back({static_cast<float>(way.x()), static_cast<float>(way.y()),
                           static_cast<float>(way.z()), static_cast<float>(at)});
    };
    for (const PieceRange& range : task.ranges) {
        const auto move_x = static_cast<float>(static_cast<double>(range.i) * model.size_mm()[0]),
                   move_y = static_cast<float>(static_cast<double>(range.j) * model.size_mm()[1]);
        const auto copy = static_cast<std::uint32_t>(range.i | range.j << 4U);
        for (std::uint32_t k = range.first; k < range.first + range.count; ++k) {
            const PieceLink& link = model.pieces()[k];
            Rod rod;
            float lows[2], highs[2];
            const Knot* const ends[]{&model.knots()[link.from], &model.knots()[link.to]};
            float at[2][3];
            for (int end = 0; end < 2; ++end) {
                const float x = ends[end]->x + move_x - sight.centre[0],
                            y = ends[end]->y + move_y - sight.centre[1], z = ends[end]->z - sight.centre[2];
                at[end][0] = dot(sight.right, x, y, z);
                at[end][1] = dot(sight.up, x, y, z);
                at[end][2] = dot(sight.away, x, y, z) + sight.eye;
            }
            rod.radius = ends[0]->radius;
            const float nearest = std::min(at[0][2], at[1][2]) - rod.radius;
            if (sight.eye > 0 && nearest < 0.02F * sight.eye) continue;  // at the eye or behind it
            for (int axis = 0; axis < 2; ++axis) {
                float reach[2], middle[2];
                for (int end = 0; end < 2; ++end) {
                    const float z = at[end][2], grow = sight.eye > 0 ? sight.eye / z : 1;
                    const float aside = at[end][axis] / z;
                    reach[end] = sight.eye > 0
                                     ? rod.radius * grow * std::sqrt(1 + aside * aside) * z / (z - rod.radius)
                                     : rod.radius;
                    middle[end] = at[end][axis] * grow;
                }
                lows[axis] = std::min(middle[0] - reach[0], middle[1] - reach[1]);
                highs[axis] = std::max(middle[0] + reach[0], middle[1] + reach[1]);
            }
            const auto pixel = [](float place, float half, float wide, int most) {
                return static_cast<int>(std::clamp((place + half) / wide, 0.0F, static_cast<float>(most)));
            };
            rod.left = pixel(lows[0], sight.half_wide, sight.pixel_wide, task.width);
            rod.right =
                std::min(pixel(highs[0], sight.half_wide, sight.pixel_wide, task.width) + 1, task.width);
            rod.low = pixel(lows[1], sight.half_high, sight.pixel_high, task.height);
            rod.high =
                std::min(pixel(highs[1], sight.half_high, sight.pixel_high, task.height) + 1, task.height);
            if (rod.left >= rod.right || rod.low >= rod.high) continue;
            rod.length2 = 0;
            for (int axis = 0; axis < 3; ++axis) {
                rod.from[axis] = at[0][axis];
                rod.axis[axis] = at[1][axis] - at[0][axis];
                rod.length2 += rod.axis[axis] * rod.axis[axis];
            }
            rod.nearest = std::clamp((nearest - sight.near) * sight.per_depth, 0.0F, 1.0F);
            rod.seen[0] = k + 1;
            rod.seen[1] = copy | link.yarn << 8U;
            rod.first_side = static_cast<std::uint32_t>(m_sides.size());
            const ModelYarn& yarn = model.yarns()[link.yarn];
            const Vec3 move(move_x, move_y, 0);
            const auto add_end = [&](std::uint32_t knot, double way) {
                const Vec3 normal = way * model.knots()[knot].tangent();
                to_side(normal, normal.dot(model.knots()[knot].place() + move));
            };
            if ((link.flags & PieceLink::near_start) != 0) add_end(yarn.first_knot, -1);
            if ((link.flags & PieceLink::near_end) != 0) add_end(yarn.last_knot(), 1);
            if (task.clip) to_side(task.clip->normal, task.clip->height);
            rod.sides = static_cast<std::uint32_t>(m_sides.size()) - rod.first_side;
            m_rods.push_back(rod);
        }
    }
}

/// Tells every band of rows what it may show, the nearest first: most of the rest then lies behind what is
/// there already.
void SoftwareFinder::sort_into_bands(const FindTask& task) {
    std::vector<std::uint32_t> first(depth_steps + 1, 0);
    const auto step = [](const Rod& rod) {
        return static_cast<std::size_t>(rod.nearest * (depth_steps - 1));
    };
    for (const Rod& rod : m_rods) ++first[step(rod) + 1];
    for (std::size_t k = 0; k < depth_steps; ++k) first[k + 1] += first[k];
    m_order.resize(m_rods.size());
    for (std::uint32_t k = 0; k < m_rods.size(); ++k) m_order[first[step(m_rods[k])]++] = k;
    m_bands.resize(static_cast<std::size_t>((task.height + band_rows - 1) / band_rows));
    for (auto& band : m_bands) band.clear();
    for (const std::uint32_t k : m_order) {
        for (int band = m_rods[k].low / band_rows; band <= (m_rods[k].high - 1) / band_rows; ++band)
            m_bands[static_cast<std::size_t>(band)].push_back(k);
    }
}

void SoftwareFinder::draw_band(const FindTask& task, std::size_t band) {
    const Sight sight = sight_of(task);
    const int first = static_cast<int>(band) * band_rows, last = std::min(first + band_rows, task.height);
    const auto width = static_cast<std::size_t>(task.width);
    std::fill_n(&m_depth[static_cast<std::size_t>(first) * width],
                static_cast<std::size_t>(last - first) * width, 1.0F);
    std::fill_n(&m_seen[2 * static_cast<std::size_t>(first) * width],
                2 * static_cast<std::size_t>(last - first) * width, 0U);
    const std::array<MeetRow, 4>& meet = sight.eye > 0 ? meetings<true> : meetings<false>;
    std::vector<float> depths(width + lanes);
    for (const std::uint32_t k : m_bands[band]) {
        const Rod& rod = m_rods[k];
        for (int y = std::max(rod.low, first); y < std::min(rod.high, last); ++y) {
            const std::size_t row = static_cast<std::size_t>(y) * width;
            float* const depth = &m_depth[row + static_cast<std::size_t>(rod.left)];
            const int wide = rod.right - rod.left;
            if (is_hidden(depth, wide, rod.nearest)) continue;
            const float v = (static_cast<float>(y) + 0.5F) * sight.pixel_high - sight.half_high;
            meet[rod.sides](rod, sight, m_sides.data() + rod.first_side, v, depths.data());
            std::uint32_t* const seen = &m_seen[2 * (row + static_cast<std::size_t>(rod.left))];
            for (int x = 0; x < wide; ++x) {
                if (depths[static_cast<std::size_t>(x)] >= depth[x]) continue;
                depth[x] = depths[static_cast<std::size_t>(x)];
                seen[2 * x] = rod.seen[0];
                seen[2 * x + 1] = rod.seen[1];
            }
        }
    }
}

void SoftwareFinder::run(const TubeModel& model, const FindTask& task) {
    const auto pixels = static_cast<std::size_t>(task.width) * static_cast<std::size_t>(task.height);
    m_depth.resize(pixels);
    m_seen.resize(2 * pixels);
    add_rods(model, task);
    sort_into_bands(task);
    m_team.run(m_bands.size(), [&](std::size_t band) { draw_band(task, band); });
}

}  // namespace weave::studio
