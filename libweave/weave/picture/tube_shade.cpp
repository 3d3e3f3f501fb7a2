#include <weave/picture/tube_shade.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace weave {

namespace {

constexpr float reach_in_radii = 6, rod_in_radii = 1.2F;
constexpr float most_cells_reached = 2.5F;  ///< so that one thick yarn among thin ones does not fill the grid
constexpr std::uint32_t most_entries = 4096;  ///< looked at for one place, so that no scene takes for ever

/// The number of a cell; two cells near one another never share one.
std::uint32_t cell_number(std::int64_t x, std::int64_t y, std::int64_t z) {
    std::uint64_t hash = 0;
    for (const std::int64_t part : {x, y, z}) {
        hash = (hash + static_cast<std::uint64_t>(part)) * 0x9e3779b97f4a7c15;
        hash ^= hash >> 32;
    }
    return static_cast<std::uint32_t>(hash);
}

float median_radius(const std::vector<float>& radii) {
    std::vector<float> sorted = radii;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    return *middle;
}

/// sRGB (IEC 61966-2-1) to amounts of light and back.
float light_of(double value) {
    return static_cast<float>(value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4));
}
double value_of(double light) {
    return light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

}  // namespace

Occlusion::Occlusion(const TubeScene& scene) {
    add_rods(scene);
    std::vector<float> radii;
    for (const Rod& rod : m_rods) radii.push_back(rod.radius);
    m_cell = reach_in_radii * median_radius(radii);
    for (Rod& rod : m_rods) rod.reach = std::min(reach_in_radii * rod.radius, most_cells_reached * m_cell);
    fill_grid();
}

void Occlusion::add_rods(const TubeScene& scene) {
    const auto& pieces = scene.pieces;
    for (std::size_t first = 0; first < pieces.size();) {
        std::size_t last = first;
        double length = (pieces[first].to - pieces[first].from).norm();
        const double wanted = rod_in_radii * pieces[first].radius;
        while (length < wanted && last + 1 < pieces.size() && pieces[last + 1].from == pieces[last].to) {
            ++last;
            length += (pieces[last].to - pieces[last].from).norm();
        }
        const Vec3 from = pieces[first].from, chord = pieces[last].to - from;
        // A long straight piece makes several rods: each stands for a place of its own.
        const auto parts = static_cast<std::size_t>(std::clamp(std::floor(length / wanted), 1.0, 1000.0));
        for (std::size_t part = 0; part < parts; ++part) {
            const Vec3 centre =
                from + chord * ((static_cast<double>(part) + 0.5) / static_cast<double>(parts));
            if (scene.cut && scene.cut->normal.dot(centre) > scene.cut->height) continue;
            m_rods.push_back({centre.cast<float>(), chord.normalized().cast<float>(),
                              static_cast<float>(length / static_cast<double>(parts)),
                              static_cast<float>(pieces[first].radius), 0});
        }
        first = last + 1;
    }
    if (m_rods.empty())  // all that is left are slivers of yarns whose middle is cut away
        m_rods.push_back({Eigen::Vector3f::Zero(), Eigen::Vector3f::UnitX(), 0, 1, 0});
}

std::int64_t Occlusion::cell_at(float coordinate) const {
    return static_cast<std::int64_t>(std::floor(std::clamp(coordinate / m_cell, -1e15F, 1e15F)));
}

Occlusion::Cells Occlusion::cells_of(const Rod& rod) const {
    Cells cells{};
    for (int axis = 0; axis < 3; ++axis) {
        cells.from[axis] = cell_at(rod.centre[axis] - rod.reach);
        cells.to[axis] = cell_at(rod.centre[axis] + rod.reach);
    }
    return cells;
}

void Occlusion::fill_grid() {
    const auto for_each_cell = [this](auto&& take) {
        for (std::uint32_t rod = 0; rod < m_rods.size(); ++rod) {
            const Cells cells = cells_of(m_rods[rod]);
            for (std::int64_t x = cells.from[0]; x <= cells.to[0]; ++x)
                for (std::int64_t y = cells.from[1]; y <= cells.to[1]; ++y)
                    for (std::int64_t z = cells.from[2]; z <= cells.to[2]; ++z)
                        take(cell_number(x, y, z), rod);
        }
    };
    std::size_t buckets = 64;
    while (buckets < 2 * m_rods.size()) buckets *= 2;
    m_mask = static_cast<std::uint32_t>(buckets - 1);
    m_first.assign(buckets + 1, 0);
    for_each_cell([this](std::uint32_t cell, std::uint32_t) { ++m_first[(cell & m_mask) + 1]; });
    for (std::size_t bucket = 0; bucket < buckets; ++bucket) m_first[bucket + 1] += m_first[bucket];
    m_entries.resize(m_first.back());
    std::vector<std::uint32_t> next(m_first.begin(), m_first.end() - 1);
    for_each_cell([&](std::uint32_t cell, std::uint32_t rod) {
        m_entries[next[cell & m_mask]++] = {cell, rod};
    });
}

float Occlusion::hidden(const Vec3& place, const Vec3& normal) const {
    const Eigen::Vector3f at = place.cast<float>(), out = normal.cast<float>();
    const std::uint32_t cell = cell_number(cell_at(at.x()), cell_at(at.y()), cell_at(at.z()));
    const std::uint32_t first = m_first[cell & m_mask],
                        last = std::min(m_first[(cell & m_mask) + 1], first + most_entries);
    float sum = 0;
    for (std::uint32_t k = first; k < last; ++k) {
        if (m_entries[k].cell != cell) continue;
        const Rod& rod = m_rods[m_entries[k].rod];
        const Eigen::Vector3f way = rod.centre - at;
        const float square = way.squaredNorm(), height = way.dot(out), reach = rod.reach * rod.reach;
        if (height <= 0 || square >= reach) continue;
        const float distance = std::sqrt(square), along = way.dot(rod.along) / distance;
        const float width = std::sqrt(std::max(0.0F, 1 - along * along));
        const float area = 2 * rod.radius * rod.length * width + 0.5F * rod.radius * rod.radius;
        const float fade = 1 - square / reach;
        sum += std::min(0.8F, area / (std::numbers::pi_v<float> * std::max(square, rod.radius * rod.radius)) *
                                  (height / distance)) *
               fade;
    }
    return sum;
}

Light to_light(Colour colour) {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> lights{};
        for (std::size_t k = 0; k < lights.size(); ++k) lights[k] = light_of(static_cast<double>(k) / 255);
        return lights;
    }();
    return {table[colour.red], table[colour.green], table[colour.blue]};
}

std::uint32_t to_pixel(const Light& light) {
    constexpr std::size_t steps = 8192;
    static const std::array<std::uint8_t, steps + 1> table = [] {
        std::array<std::uint8_t, steps + 1> values{};
        for (std::size_t k = 0; k <= steps; ++k)
            values[k] =
                static_cast<std::uint8_t>(std::lround(255 * value_of(static_cast<double>(k) / steps)));
        return values;
    }();
    const auto byte = [](float amount) {
        return table[static_cast<std::size_t>(std::clamp(amount, 0.0F, 1.0F) * steps + 0.5F)];
    };
    return pixel_of({byte(light[0]), byte(light[1]), byte(light[2])});
}

Light shaded(const Light& colour, const Vec3& normal, const Vec3& way, float hidden, bool even) {
    // A lamp over the viewer's left shoulder, and light from the whole sky.
    static const Vec3 lamp = Vec3(-0.42, 0.68, -0.60).normalized();
    const double facing = std::max(0.0, -normal.dot(way));
    const auto lit = static_cast<float>(std::max(0.0, (normal.dot(lamp) + 0.30) / 1.30));
    const auto sky = static_cast<float>(0.5 + 0.5 * normal.y());
    const float open = std::exp(-1.0F * hidden);
    const float edge = static_cast<float>(std::min(1.0, facing / 0.45)), rim = edge * (2 - edge);
    const float shine =
        static_cast<float>(std::pow(std::max(0.0, normal.dot((lamp - way).normalized())), 30)) * 0.06F * open;
    if (even) {
        const float light = (0.42F + 0.62F * lit * open) * (0.45F + 0.55F * open) * (0.6F + 0.4F * rim);
        return colour * (light + 0.08F) + shine;
    }
    const float light = (0.34F + 0.16F * sky) * open + 0.74F * lit * std::sqrt(open) * (0.3F + 0.7F * open);
    return colour * light * (0.50F + 0.50F * rim) + shine;
}

}  // namespace weave
