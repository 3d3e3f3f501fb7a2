#include <studio/viewport/tube_model.hpp>

#include <weave/picture/yarn_knots.hpp>
#include <weave/sim/planned_yarns.hpp>
#include <weave/sim/sampled.hpp>
#include <weave/sim/strands.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <future>
#include <numeric>
#include <tuple>

namespace weave::studio {

namespace {

/// How far the finest pieces stray from their yarn, of its radius: finer while that is cheap.
constexpr double fine_shares[]{0.02, 0.045, 0.1};
constexpr std::size_t cheap_knots = 300'000, most_knots = std::size_t{1} << 23;
/// The coarser levels, of the thinnest radius.
constexpr double level_shares[]{0.12, 0.4, 1.2};
constexpr std::uint32_t chunk_pieces = 64, longest_merge = 64;
constexpr std::size_t least_pieces = 2;  ///< of a segment, for yarns that bend more once they move
/// Blue and orange, which colour-blind people tell apart.
constexpr Colour system_warp{0xe6, 0x8a, 0x1e}, system_weft{0x4c, 0x84, 0xb8};

ClothColour cloth_colour(ColourBy colour) {
    switch (colour) {
        case ColourBy::strain:
            return ClothColour::strain;
        case ColourBy::contact:
            return ClothColour::contact;
        case ColourBy::moved:
            return ClothColour::moved;
        case ColourBy::yarn:
        case ColourBy::system:
            break;
    }
    return ClothColour::yarn;
}

Status check(const Yarns& yarns) {
    if (yarns.yarns.empty()) return invalid("there is no yarn to show");
    for (const SimulatedYarn& yarn : yarns.yarns) {
        const std::size_t points = yarn.spline.control.size();
        if (points == 0 || !(yarn.radius_mm > 0)) return invalid("a yarn has no points, or no thickness");
        if (yarn.planned.size() != points || yarn.strain.size() != points || yarn.contact_N.size() != points)
            return invalid(
                "a yarn has not one planned place, strain and contact force for each control point");
    }
    return {};
}

using Lines = std::vector<std::vector<double>>;

Result<Lines> parameters_of(const Yarns& yarns) {
    Lines lines;
    for (const double share : fine_shares) {
        lines.clear();
        std::size_t knots = 0;
        for (const SimulatedYarn& yarn : yarns.yarns) {
            lines.push_back(sample_parameters(yarn.spline, share * yarn.radius_mm, least_pieces));
            if (lines.back().empty()) lines.back().push_back(0);  // a single point
            knots += lines.back().size();
            if (knots > (share == fine_shares[2] ? most_knots : cheap_knots)) break;
        }
        if (lines.size() == yarns.yarns.size() &&
            knots <= (share == fine_shares[2] ? most_knots : cheap_knots))
            return lines;
    }
    return invalid("there are more yarns than the 3D view can draw: save them, or simulate a part of the cloth and look at that");
}

Spline planned_spline(const SimulatedYarn& yarn) {
    return {yarn.planned, yarn.spline.is_periodic, yarn.spline.shift};
}

}  // namespace

Result<TubeModel> TubeModel::planned(const Design& design, const ClothCurves& curves, ColourBy colour) {
    return relaxed(std::make_shared<const Yarns>(sim::planned_yarns(design, curves)), colour);
}

Result<TubeModel> TubeModel::relaxed(std::shared_ptr<const Yarns> yarns, ColourBy colour) {
    if (yarns == nullptr) return invalid("there is no yarn to show");
    WEAVE_CHECK_OK(check(*yarns));
    TubeModel model;
    WEAVE_TRY(model.m_parameters, parameters_of(*yarns));
    model.m_source = std::move(yarns);
    auto crossings = std::async(std::launch::async, [&model] { model.find_crossings(); });  // beside the pieces
    model.lay_out();
    crossings.get();
    model.set_colour(colour);
    return model;
}

void TubeModel::lay_out() {
    m_thinnest = std::numeric_limits<double>::infinity();
    std::vector<Spline> splines;
    const std::vector<Colour> colours = own_colours(*m_source);
    std::uint32_t knots = 0;
    for (std::size_t y = 0; y < colours.size(); ++y) {
        const SimulatedYarn& yarn = m_source->yarns[y];
        const auto count = static_cast<std::uint32_t>(m_parameters[y].size());
        m_yarns.push_back({yarn.system, yarn.number, yarn.beam, yarn.radius_mm, colours[y], knots, count});
        knots += count;
        m_thinnest = std::min(m_thinnest, yarn.radius_mm);
        splines.push_back(yarn.spline);
    }
    m_knots.resize(knots);
    place_knots(splines);
    add_levels();
    measure();
}

void TubeModel::place_knots(const std::vector<Spline>& splines) {
    for (std::size_t y = 0; y < splines.size(); ++y) {
        const Spline& spline = splines[y];
        const std::size_t before = std::max<std::size_t>(1, m_source->yarns[y].spline.segments());
        const double stretch = static_cast<double>(spline.segments()) / static_cast<double>(before);
        Knot* knot = &m_knots[m_yarns[y].first_knot];
        Vec3 along(1, 0, 0);
        for (const double t : m_parameters[y]) {
            const Vec3 place = spline.place(t * stretch), way = spline.tangent(t * stretch);
            const double length = way.norm();
            if (length > 0) along = way / length;
            knot->x = static_cast<float>(place.x());
            knot->y = static_cast<float>(place.y());
            knot->z = static_cast<float>(place.z());
            knot->radius = static_cast<float>(m_yarns[y].radius_mm);
            knot->along_x = static_cast<float>(along.x());
            knot->along_y = static_cast<float>(along.y());
            knot->along_z = static_cast<float>(along.z());
            ++knot;
        }
    }
}

/// Each level leaves out joints of the one before, which is much quicker than to begin at all knots again: what it strays further
/// adds up to no more than its error.
void TubeModel::add_levels() {
    std::vector<Joints> joints;
    for (const ModelYarn& yarn : m_yarns) {
        joints.emplace_back(yarn.knots);
        std::iota(joints.back().begin(), joints.back().end(), yarn.first_knot);
    }
    add_level(0, joints);
    double error_mm = 0;
    for (const double share : level_shares) {
        for (Joints& one : joints) one = fewer(one, share * m_thinnest - error_mm);
        error_mm = share * m_thinnest;
        add_level(error_mm, joints);
    }
}

void TubeModel::add_level(double error_mm, const std::vector<Joints>& joints) {
    Level level{error_mm, static_cast<std::uint32_t>(m_pieces.size()), 0, 0, {}};
    for (std::uint32_t yarn = 0; yarn < m_yarns.size(); ++yarn) add_pieces(yarn, joints[yarn]);
    const auto first = m_pieces.begin() + level.first;
    const auto flat =
        std::stable_partition(first, m_pieces.end(), [](const PieceLink& piece) { return piece.flags == 0; });
    const auto add_chunks = [&](std::uint32_t from, std::uint32_t to) {
        for (; from < to; from += chunk_pieces)
            level.chunks.push_back(Chunk{.first = from, .count = std::min(chunk_pieces, to - from)});
    };
    level.count = static_cast<std::uint32_t>(m_pieces.end() - first);
    level.first_flat = static_cast<std::uint32_t>(flat - m_pieces.begin());
    add_chunks(level.first, level.first_flat);
    add_chunks(level.first_flat, level.first + level.count);
    m_levels.push_back(std::move(level));
}

/// The joints that are left where none of those between two lies further than `room_mm` from the straight line.
TubeModel::Joints TubeModel::fewer(const Joints& joints, double room_mm) const {
    const auto strays = [&](std::size_t from, std::size_t to) {
        const Knot &start = m_knots[joints[from]], &end = m_knots[joints[to]];
        if (joints[to] - joints[from] > longest_merge || start.tangent().dot(end.tangent()) < 0.5) return true;
        const Vec3 chord = end.place() - start.place();
        const double per_length = 1 / std::max(chord.squaredNorm(), 1e-30);
        for (std::size_t k = from + 1; k < to; ++k) {
            const Vec3 way = m_knots[joints[k]].place() - start.place();
            const double share = std::clamp(way.dot(chord) * per_length, 0.0, 1.0);
            if ((way - share * chord).squaredNorm() > room_mm * room_mm) return true;
        }
        return false;
    };
    Joints left{joints.front()};
    for (std::size_t from = 0; from + 1 < joints.size();) {
        std::size_t to = from + 1;
        while (to + 1 < joints.size() && !strays(from, to + 1)) ++to;
        left.push_back(joints[to]);
        from = to;
    }
    return left;
}

void TubeModel::add_pieces(std::uint32_t yarn, const Joints& joints) {
    const ModelYarn& of = m_yarns[yarn];
    const Vec3 start = m_knots[of.first_knot].place(), end = m_knots[of.last_knot()].place();
    const double near = 1.5 * of.radius_mm;
    if (joints.size() == 1) m_pieces.push_back({joints[0], joints[0], yarn, 0});
    for (std::size_t k = 0; k + 1 < joints.size(); ++k) {
        const std::uint32_t from = joints[k], to = joints[k + 1];
        const std::uint32_t flags = ((m_knots[from].place() - start).norm() < near ? PieceLink::near_start : 0U) |
                                    ((m_knots[to].place() - end).norm() < near ? PieceLink::near_end : 0U);
        m_pieces.push_back({from, to, yarn, flags});
    }
}

void TubeModel::measure() {
    Eigen::AlignedBox3f all;
    for (Level& level : m_levels) {
        for (Chunk& chunk : level.chunks) {
            Eigen::AlignedBox3f box;
            for (std::uint32_t k = chunk.first; k < chunk.first + chunk.count; ++k) {
                for (const std::uint32_t end : {m_pieces[k].from, m_pieces[k].to}) {
                    const Knot& knot = m_knots[end];
                    const Eigen::Vector3f at(knot.x, knot.y, knot.z),
                        room = Eigen::Vector3f::Constant(knot.radius);
                    box.extend(at - room).extend(at + room);
                }
            }
            chunk.low = box.min();
            chunk.high = box.max();
        }
    }
    for (const Knot& knot : m_knots) {  // without the round ends, which are cut off
        const Eigen::Vector3f at(knot.x, knot.y, knot.z), along(knot.along_x, knot.along_y, knot.along_z);
        const Eigen::Vector3f room = knot.radius * (1 - along.array().square()).max(0).sqrt().matrix();
        all.extend(at - room).extend(at + room);
    }
    m_box = {all.min().cast<double>(), all.max().cast<double>()};
}

void TubeModel::set_colour(ColourBy colour) {
    m_colour = colour;
    const std::vector<Colour> own = own_colours(*m_source);
    for (std::size_t y = 0; y < m_yarns.size(); ++y)
        m_yarns[y].colour = colour != ColourBy::system          ? own[y]
                            : m_yarns[y].system == System::warp ? system_warp
                                                                : system_weft;
    set_values();
}

void TubeModel::set_values() {
    if (!is_scalar()) return;
    const ClothColour colour = cloth_colour(m_colour);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t y = 0; y < m_yarns.size(); ++y) {
        const SimulatedYarn& yarn = m_source->yarns[y];
        const Spline planned = planned_spline(yarn);
        const bool live = m_is_live && m_colour == ColourBy::moved;
        Knot* knot = &m_knots[m_yarns[y].first_knot];
        for (const double t : m_parameters[y]) {
            const double value =
                live ? (knot->place() - planned.place(t)).norm() : value_of(yarn, planned, colour, t);
            knot->value = static_cast<float>(value);
            least = std::min(least, value);
            most = std::max(most, value);
            ++knot;
        }
    }
    const ValueRange range = scale_of(*m_source, colour, least, most);
    m_low = range.low;
    m_high = range.high;
}

Status TubeModel::update(const std::vector<std::vector<Vec3>>& control) {
    if (control.size() != m_yarns.size())
        return invalid("these are not the places of the yarns that are shown");
    for (std::size_t y = 0; y < control.size(); ++y) {
        if (control[y].size() < (m_source->yarns[y].spline.is_periodic ? 1U : 2U))
            return invalid("a yarn has too few points to be shown");
    }
    m_now.resize(control.size());
    for (std::size_t y = 0; y < control.size(); ++y) {
        m_now[y].control = control[y];  // whose memory is used again
        m_now[y].is_periodic = m_source->yarns[y].spline.is_periodic;
        m_now[y].shift = m_source->yarns[y].spline.shift;
    }
    m_is_live = true;
    place_knots(m_now);
    measure();
    if (m_colour == ColourBy::moved) set_values();
    return {};
}

TubePiece TubeModel::piece(std::size_t index) const {
    const PieceLink& link = m_pieces[index];
    const Knot &from = m_knots[link.from], &to = m_knots[link.to];
    TubePiece piece;
    piece.from = from.place();
    piece.to = to.place();
    piece.tangent_from = from.tangent().cast<float>();
    piece.tangent_to = to.tangent().cast<float>();
    piece.radius = from.radius;
    piece.yarn = link.yarn;
    piece.value_from = from.value;
    piece.value_to = to.value;
    return piece;
}

void TubeModel::find_crossings() {
    const auto places = sim::crossing_places(*m_source);
    if (!places)
        return;  // a file that does not tell: yarns can be looked at, but none is found by its crossing
    for (std::size_t k = 0; k < places->size(); ++k) {
        const Crossing& of = m_source->crossings[k];
        Vec3 weft = (*places)[k].weft, warp = (*places)[k].warp;
        if (const auto& spot = (*places)[k].spot) {
            weft = m_source->yarns[of.weft].spline.place(spot->weft_at);
            warp = m_source->yarns[of.warp].spline.place(spot->warp_at);
        }
        // The two may be of different repeats: the warp's nearest to the weft is the one that it passes.
        Vec3 way = warp - weft;
        for (int axis = 0; axis < 2; ++axis) {
            const double period =
                is_periodic()[static_cast<std::size_t>(axis)] ? size_mm()[static_cast<std::size_t>(axis)] : 0;
            if (period > 0) way[axis] = std::remainder(way[axis], period);
        }
        const Vec3 place = weft + way / 2;
        m_crossings.push_back({static_cast<std::uint32_t>(of.weft), static_cast<std::uint32_t>(of.warp),
                               of.pick, of.end, place});
    }
    std::ranges::stable_sort(m_crossings, {},
                             [](const ModelCrossing& of) { return std::pair(of.weft, of.warp); });
}

double TubeModel::apart(const Vec3& a, const Vec3& b) const {
    Vec3 way = a - b;
    for (int axis = 0; axis < 2; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        if (is_periodic()[k] && size_mm()[k] > 0) way[axis] = std::remainder(way[axis], size_mm()[k]);
    }
    return way.norm();
}

std::optional<ModelCrossing> TubeModel::crossing_of(std::uint32_t yarn, std::uint32_t other,
                                                    const Vec3& near) const {
    if (m_yarns[yarn].system == m_yarns[other].system) return std::nullopt;
    const bool weft_first = m_yarns[yarn].system == System::weft;
    const std::pair wanted = weft_first ? std::pair(yarn, other) : std::pair(other, yarn);
    const auto found = std::ranges::equal_range(
        m_crossings, wanted, {}, [](const ModelCrossing& of) { return std::pair(of.weft, of.warp); });
    const auto nearest =
        std::ranges::min_element(found, {}, [&](const ModelCrossing& of) { return apart(of.place, near); });
    if (nearest == found.end()) return std::nullopt;
    return *nearest;
}

std::optional<std::uint32_t> TubeModel::find(System system, std::size_t number) const {
    const auto named = std::ranges::find_if(
        m_yarns, [&](const ModelYarn& yarn) { return yarn.system == system && yarn.number == number; });
    if (named != m_yarns.end()) return static_cast<std::uint32_t>(named - m_yarns.begin());
    if (system == System::warp) return std::nullopt;
    const auto crossing = std::ranges::find(m_crossings, number, &ModelCrossing::pick);
    if (crossing == m_crossings.end()) return std::nullopt;
    return crossing->weft;
}

std::size_t TubeModel::number_at(std::uint32_t yarn, const Vec3& place) const {
    if (m_yarns[yarn].system == System::warp) return m_yarns[yarn].number;
    const auto own = std::ranges::equal_range(m_crossings, yarn, {}, &ModelCrossing::weft);
    const auto nearest =
        std::ranges::min_element(own, {}, [&](const ModelCrossing& of) { return apart(of.place, place); });
    return nearest == own.end() ? m_yarns[yarn].number : nearest->pick;
}

}  // namespace weave::studio
