#include <weave/picture/tube_scene.hpp>

#include <weave/picture/yarn_knots.hpp>
#include <weave/sim/sampled.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace weave {

namespace {

/// How far pieces stray from their yarn, of its radius: finer while that is cheap.
constexpr double fine_share = 0.02, coarse_share = 0.045;
constexpr std::size_t cheap_pieces = 200'000;

Error usage(std::string message) {
    return {ErrorCode::usage, std::move(message), {}};
}

using Lines = std::vector<std::vector<double>>;

std::size_t pieces_of(const Lines& lines) {
    std::size_t pieces = 0;
    for (const auto& line : lines) pieces += line.empty() ? 0 : line.size() - 1;
    return pieces;
}

Result<Lines> sampled(const Yarns& yarns, double share, std::size_t most) {
    Lines lines;
    std::size_t pieces = 0;
    for (const SimulatedYarn& yarn : yarns.yarns) {
        lines.push_back(sample_parameters(yarn.spline, share * yarn.radius_mm));
        pieces += lines.back().size();
        if (pieces > most) {
            return invalid("the picture would have more than " + std::to_string(most_tube_pieces) +
                           " pieces of yarn: show a smaller region, or repeat it less often");
        }
    }
    return lines;
}

Result<Lines> lines_of(const Yarns& yarns, std::size_t copies) {
    if (auto fine = sampled(yarns, fine_share, cheap_pieces / copies)) return fine;
    return sampled(yarns, coarse_share, most_tube_pieces / copies);
}

void set_range(TubeScene& scene, const Yarns& yarns, ClothColour colour) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const TubePiece& piece : scene.pieces) {
        for (const double value : {double{piece.value_from}, double{piece.value_to}}) {
            least = std::min(least, value);
            most = std::max(most, value);
        }
    }
    const ValueRange range = scale_of(yarns, colour, least, most);
    scene.low = range.low;
    scene.high = range.high;
}

// ---- Pieces ----

/// Makes the pieces of yarns, in the axes of the cloth.
class SceneMaker {
  public:
    SceneMaker(const Yarns& yarns, const ClothView& view, const Lines& lines)
        : m_yarns(yarns), m_view(view), m_lines(lines) {}

    TubeScene make() {
        m_scene.pieces.reserve(pieces_of(m_lines) * m_view.repeat[0] * m_view.repeat[1]);
        if (m_view.cut) {
            const Vec3 normal = m_view.cut->normal.normalized();
            m_scene.cut = Plane{normal, normal.dot(m_view.cut->point)};
        }
        for (std::size_t yarn = 0; yarn < m_yarns.yarns.size(); ++yarn) add(yarn);
        return std::move(m_scene);
    }

  private:
    void add(std::size_t number) {
        if (m_lines[number].empty()) return;
        const std::vector<YarnKnot> knots = knots_of(m_yarns.yarns[number], m_lines[number], m_view.colour);
        for (std::size_t i = 0; i < m_view.repeat[0]; ++i) {
            for (std::size_t j = 0; j < m_view.repeat[1]; ++j) {
                const Vec3 move(static_cast<double>(i) * m_yarns.size_mm[0],
                                static_cast<double>(j) * m_yarns.size_mm[1], 0);
                add_copy(number, knots, move);
            }
        }
    }

    void add_copy(std::size_t number, const std::vector<YarnKnot>& knots, const Vec3& move) {
        const auto plane_at = [&](const YarnKnot& knot, double way) {
            const Vec3 normal = way * knot.tangent;
            m_scene.planes.push_back({normal, normal.dot(knot.place + move)});
            return static_cast<std::uint32_t>(m_scene.planes.size() - 1);
        };
        const std::uint32_t start = plane_at(knots.front(), -1), end = plane_at(knots.back(), 1);
        // The round ends of pieces stand out past the yarn's end if it is nearer than a radius.
        const double near = 1.5 * m_yarns.yarns[number].radius_mm;
        for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
            TubePiece piece = piece_between(number, knots[k], knots[k + 1], move);
            if (m_scene.cut && !keep(piece)) continue;
            if (knots[k].along < near) piece.plane_from = start;
            if (knots.back().along - knots[k + 1].along < near) piece.plane_to = end;
            m_scene.pieces.push_back(piece);
        }
    }

    [[nodiscard]] TubePiece piece_between(std::size_t number, const YarnKnot& a, const YarnKnot& b,
                                          const Vec3& move) const {
        TubePiece piece;
        piece.from = a.place + move;
        piece.to = b.place + move;
        piece.tangent_from = a.tangent.cast<float>();
        piece.tangent_to = b.tangent.cast<float>();
        piece.radius = m_yarns.yarns[number].radius_mm;
        piece.yarn = static_cast<std::uint32_t>(number);
        piece.value_from = static_cast<float>(a.value);
        piece.value_to = static_cast<float>(b.value);
        return piece;
    }

    /// How far a disc across the yarn reaches towards what is cut away.
    [[nodiscard]] double reach(const Vec3& place, const Eigen::Vector3f& tangent, double radius) const {
        const double along = m_scene.cut->normal.dot(tangent.cast<double>());
        return m_scene.cut->normal.dot(place) + radius * std::sqrt(std::max(0.0, 1 - along * along));
    }

    /// Takes off the ends of a piece that lie more than a radius beyond the cut, so that it is not framed by
    /// what nobody sees; false where nothing is left.
    [[nodiscard]] bool keep(TubePiece& piece) {
        const auto beyond = [&](const Vec3& place) {
            return m_scene.cut->normal.dot(place) - m_scene.cut->height - piece.radius;
        };
        const double from = beyond(piece.from), to = beyond(piece.to);
        m_scene.is_cut_through |= reach(piece.from, piece.tangent_from, piece.radius) > m_scene.cut->height ||
                                  reach(piece.to, piece.tangent_to, piece.radius) > m_scene.cut->height;
        if (from >= 0 && to >= 0) return false;
        if (from <= 0 && to <= 0) return true;
        const double share = from / (from - to);
        const Vec3 place = piece.from + share * (piece.to - piece.from);
        const float value =
            piece.value_from + static_cast<float>(share) * (piece.value_to - piece.value_from);
        (from > 0 ? piece.from : piece.to) = place;
        (from > 0 ? piece.value_from : piece.value_to) = value;
        return true;
    }

    const Yarns& m_yarns;
    const ClothView& m_view;
    const Lines& m_lines;
    TubeScene m_scene;
};

/// The box round all pieces, in the cloth's axes, with ends that are flat.
Eigen::AlignedBox3d box_round(const TubeScene& scene) {
    Eigen::AlignedBox3d box;
    const auto add = [&](const Vec3& place, const Eigen::Vector3f& tangent, double radius) {
        // A disc across the yarn is as wide along an axis as the sine between the two.
        const Vec3 room = radius * (1 - tangent.cast<double>().array().square()).max(0).sqrt().matrix();
        box.extend(place - room).extend(place + room);
    };
    for (const TubePiece& piece : scene.pieces) {
        add(piece.from, piece.tangent_from, piece.radius);
        add(piece.to, piece.tangent_to, piece.radius);
    }
    for (int axis = 0; scene.cut && axis < 3; ++axis) {
        const double way = scene.cut->normal[axis];
        if (way == 1) box.max()[axis] = std::min(box.max()[axis], scene.cut->height);
        if (way == -1) box.min()[axis] = std::max(box.min()[axis], -scene.cut->height);
    }
    return box;
}

Plane turned(const Plane& plane, const TubeCamera& camera) {
    const Vec3 normal = camera.turned(plane.normal);
    return {normal, normal.dot(camera.to_camera(plane.height * plane.normal))};
}

void turn_to(TubeScene& scene, const TubeCamera& camera) {
    for (TubePiece& piece : scene.pieces) {
        piece.from = camera.to_camera(piece.from);
        piece.to = camera.to_camera(piece.to);
        piece.tangent_from = camera.turned(piece.tangent_from.cast<double>()).cast<float>();
        piece.tangent_to = camera.turned(piece.tangent_to.cast<double>()).cast<float>();
    }
    for (Plane& plane : scene.planes) plane = turned(plane, camera);
    if (scene.cut) scene.cut = turned(*scene.cut, camera);
}

Status check(const Yarns& yarns, const ClothView& view) {
    if (yarns.yarns.empty()) return invalid("there is no yarn to draw");
    for (std::size_t axis = 0; axis < 2; ++axis) {
        if (view.repeat[axis] == 0) return usage("a piece is shown at least once");
        if (view.repeat[axis] > 1 && !yarns.is_periodic[axis]) {
            return usage(std::string("the piece does not repeat along ") +
                         (axis == 0 ? "the ends (x)" : "the picks (y)") +
                         ", so it can be shown there only once");
        }
    }
    if (view.cut && !(view.cut->normal.norm() > 0))
        return usage("a plane to cut by needs a normal that is not 0");
    for (const SimulatedYarn& yarn : yarns.yarns) {
        const std::size_t points = yarn.spline.control.size();
        if (yarn.planned.size() != points || yarn.strain.size() != points || yarn.contact_N.size() != points)
            return invalid(
                "a yarn has not one planned place, strain and contact force for each control point");
    }
    return {};
}

}  // namespace

Result<TubeScene> make_scene(const Yarns& yarns, const ClothView& view, TubeCamera& camera) {
    WEAVE_CHECK_OK(check(yarns, view));
    WEAVE_TRY(const Lines lines, lines_of(yarns, std::min(view.repeat[0], most_tube_pieces) *
                                                     std::min(view.repeat[1], most_tube_pieces)));
    TubeScene scene = SceneMaker(yarns, view, lines).make();
    if (scene.pieces.empty()) {
        return view.cut ? usage("the cut leaves nothing to see: " + view.cut->words)
                        : invalid("there is no yarn to draw");
    }
    if (view.colour == ClothColour::yarn) {
        scene.colours = own_colours(yarns);
    } else {
        set_range(scene, yarns, view.colour);
    }
    const Eigen::AlignedBox3d box = box_round(scene);
    scene.size = box.sizes();
    double thickest = 0;
    for (const TubePiece& piece : scene.pieces) thickest = std::max(thickest, piece.radius);
    camera.aim(box.center(), box.sizes().norm() / 2 + thickest, view.perspective);
    turn_to(scene, camera);
    return scene;
}

Rectangle box_of(const TubeScene& scene, const TubeCamera& camera) {
    Eigen::AlignedBox2d box;
    for (const TubePiece& piece : scene.pieces) {
        for (const Vec3& end : {piece.from, piece.to}) {
            const Rectangle ball = camera.box_of(end, piece.radius);
            box.extend(Eigen::Vector2d(ball.x, ball.y));
            box.extend(Eigen::Vector2d(ball.x + ball.width, ball.y + ball.height));
        }
    }
    return {box.min().x(), box.min().y(), box.sizes().x(), box.sizes().y()};
}

}  // namespace weave
