#include <studio/viewport/picking.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace weave::studio {

namespace {

/// How far from a crossing's middle a click still means it, in radii of the thinner yarn.
constexpr double crossing_reach = 0.75;

/// Whether a ray meets a box.
bool meets(const Ray& ray, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
    double from = 0, to = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        const double start = ray.origin[axis], way = ray.way[axis];
        if (std::abs(way) < 1e-12) {
            if (start < low[axis] || start > high[axis]) return false;
            continue;
        }
        const double a = (low[axis] - start) / way, b = (high[axis] - start) / way;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to;
}

/// Finds what one repeat has on a ray.
class Finder {
  public:
    Finder(const TubeModel& model, const Ray& ray, const std::optional<Plane>& clip)
        : m_model(model), m_ray(ray), m_clip(clip) {}

    /// Of each yarn the nearest place.
    std::map<std::uint32_t, Hit> run() {
        for (const Chunk& chunk : m_model.levels().front().chunks) {
            if (!meets(m_ray, chunk.low, chunk.high)) continue;
            for (std::uint32_t k = chunk.first; k < chunk.first + chunk.count; ++k) look_at(k);
        }
        return std::move(m_found);
    }

  private:
    void look_at(std::uint32_t index) {
        Stretch stretch = within(m_model.piece(index), m_ray);
        if (stretch.is_empty()) return;
        const PieceLink& link = m_model.pieces()[index];
        const ModelYarn& yarn = m_model.yarns()[link.yarn];
        const auto keep = [&](const Plane& plane) {
            const Stretch kept = behind(plane, m_ray);
            const bool is_cut = kept.from > stretch.from;
            stretch.from = std::max(stretch.from, kept.from);
            stretch.to = std::min(stretch.to, kept.to);
            return is_cut;
        };
        const auto keep_end = [&](std::uint32_t knot, double way) {
            const Knot& at = m_model.knots()[knot];
            const Vec3 normal = way * at.tangent();
            keep({normal, normal.dot(at.place())});
        };
        if ((link.flags & PieceLink::near_start) != 0) keep_end(yarn.first_knot, -1);
        if ((link.flags & PieceLink::near_end) != 0) keep_end(yarn.last_knot(), 1);
        const bool is_cut = m_clip && keep(*m_clip);
        if (stretch.is_empty() || stretch.from < 0) return;
        Hit& hit = m_found[link.yarn];
        hit.yarn = link.yarn;
        if (stretch.from < hit.distance) {
            hit.distance = stretch.from;
            hit.place = m_ray.origin + stretch.from * m_ray.way;
            hit.is_cut = is_cut;
        }
    }

    const TubeModel& m_model;
    const Ray& m_ray;
    const std::optional<Plane>& m_clip;
    std::map<std::uint32_t, Hit> m_found;
};

}  // namespace

bool operator==(const Shown& a, const Shown& b) {
    const bool same_cut = a.clip.has_value() == b.clip.has_value() &&
                          (!a.clip || (a.clip->normal == b.clip->normal && a.clip->height == b.clip->height));
    return same_cut && a.repeat == b.repeat;
}

Box box_of(const TubeModel& model, const std::array<std::size_t, 2>& repeat) {
    Box box = model.box();
    box.high.x() += static_cast<double>(repeat[0] - 1) * model.size_mm()[0];
    box.high.y() += static_cast<double>(repeat[1] - 1) * model.size_mm()[1];
    return box;
}

std::vector<Hit> hits(const TubeModel& model, const Shown& shown, const Ray& ray) {
    std::vector<Hit> all;
    for (std::size_t i = 0; i < shown.repeat[0]; ++i) {
        for (std::size_t j = 0; j < shown.repeat[1]; ++j) {
            const Vec3 move(static_cast<double>(i) * model.size_mm()[0],
                            static_cast<double>(j) * model.size_mm()[1], 0);
            const Ray moved{ray.origin - move, ray.way};
            std::optional<Plane> clip = shown.clip;
            if (clip) clip->height -= clip->normal.dot(move);
            for (auto& [yarn, hit] : Finder(model, moved, clip).run()) {
                hit.place += move;
                all.push_back(hit);
            }
        }
    }
    std::ranges::sort(all, {}, &Hit::distance);
    return all;
}

std::optional<ModelCrossing> crossing_at(const TubeModel& model, const std::vector<Hit>& hits,
                                         const Ray& ray) {
    if (hits.size() < 2) return std::nullopt;
    const auto crossing = model.crossing_of(hits[0].yarn, hits[1].yarn, (hits[0].place + hits[1].place) / 2);
    if (!crossing) return std::nullopt;
    // Across the line of sight, for the middle lies below what is seen.
    Vec3 middle = crossing->place;
    for (int axis = 0; axis < 2; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        const double period = model.is_periodic()[k] ? model.size_mm()[k] : 0;
        if (period > 0) middle[axis] += period * std::round((hits[0].place[axis] - middle[axis]) / period);
    }
    const Vec3 way = middle - ray.origin, across = way - way.dot(ray.way) * ray.way;
    const double thinner =
        std::min(model.yarns()[hits[0].yarn].radius_mm, model.yarns()[hits[1].yarn].radius_mm);
    if (across.norm() > crossing_reach * thinner) return std::nullopt;
    return crossing;
}

}  // namespace weave::studio
