#include <weave/sim/plan.hpp>

#include <weave/core/text.hpp>
#include <weave/core/units.hpp>
#include <weave/curve/spline.hpp>
#include <weave/design/pins.hpp>
#include <weave/loom/pick_table.hpp>
#include <weave/sim/fabric.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace weave::sim {

namespace {

/// Wefts are inserted a little longer than the cloth is wide.
constexpr double weft_excess = 0.01;
constexpr double most_neighbours = 1e4;  ///< of one contact sample, as a rough bound from above tells
constexpr std::size_t rim_points = 2;  ///< control points held at a frozen end

struct Resolution {
    double points_per_key, sample_spacing, goal;
};

Resolution resolution_of(Fidelity fidelity) {
    switch (fidelity) {
        case Fidelity::draft:
            return {2, 0.25, 1e-2};
        case Fidelity::standard:
            return {4, 0.25, 1e-3};
        case Fidelity::reference:
            break;
    }
    return {8, 0.125, 1e-8};
}

/// The smallest period of a line: equal(i, i + period) for all i, and a divisor of the length.
template <class Equal>
std::size_t period_of(std::size_t length, Equal equal) {
    for (std::size_t period = 1; period < length; ++period) {
        if (length % period != 0) continue;
        bool repeats = true;
        for (std::size_t i = 0; repeats && i + period < length; ++i) repeats = equal(i, i + period);
        if (repeats) return period;
    }
    return length;
}

bool feeds_alike(const std::vector<Pick>& picks, std::size_t a, std::size_t b) {
    return picks[a].feeders == picks[b].feeders;
}

/// Which picks, or which ends, the scene pins; each of them must be there, see check_pins().
std::vector<std::uint8_t> pinned(const Design& design, bool picks, std::size_t count) {
    std::vector<std::uint8_t> numbers(count, 0);
    for (const Pin& pin : design.scene.pins) {
        if (pin.is_pick == picks) numbers[pin.number] = 1;
    }
    return numbers;
}

/// Rows and columns of the smallest repeat of the cloth, its yarns and pins included.
std::array<std::size_t, 2> smallest_repeat(const Design& design, const Block& block) {
    const std::vector<Pick> picks = pick_table(design, block);
    const std::vector<std::uint8_t> pinned_picks = pinned(design, true, block.picks()),
                                    pinned_ends = pinned(design, false, block.ends());
    const std::size_t rows = period_of(block.rows(), [&](std::size_t i, std::size_t j) {
        if (block.t()[i] != block.t()[j] || !std::ranges::equal(block.cells(i), block.cells(j))) return false;
        for (std::size_t k = 0; k < block.t()[i]; ++k) {
            const std::size_t a = block.first_pick(i) + k, b = block.first_pick(j) + k;
            if (!feeds_alike(picks, a, b) || pinned_picks[a] != pinned_picks[b]) return false;
        }
        return true;
    });
    const std::size_t columns = period_of(block.columns(), [&](std::size_t i, std::size_t j) {
        if (block.p()[i] != block.p()[j]) return false;
        for (std::size_t k = 0; k < block.p()[i]; ++k) {
            const std::size_t a = block.first_end(i) + k, b = block.first_end(j) + k;
            if (design.warp.order.at(a) != design.warp.order.at(b) || pinned_ends[a] != pinned_ends[b]) return false;
        }
        for (std::size_t row = 0; row < block.rows(); ++row) {
            if (block.cells(row)[i] != block.cells(row)[j]) return false;
        }
        return true;
    });
    return {rows, columns};
}

Result<Block> first_repeat(const Block& block, std::size_t rows, std::size_t columns) {
    std::vector<std::uint32_t> t(block.t().begin(), block.t().begin() + static_cast<std::ptrdiff_t>(rows)),
        p(block.p().begin(), block.p().begin() + static_cast<std::ptrdiff_t>(columns));
    return make_block(
        std::move(t), std::move(p), [&](std::size_t row, std::size_t column) { return block.stack(row, column); },
        block.height());
}

/// Length that a weft is cut to: as it lies on the loom, straight along each pick and round each turn.
double inserted_length(const YarnCurve& curve) {
    if (curve.is_periodic && curve.shift.y() != 0) return curve.shift.norm();
    const auto between = [](const KeyPoint& from, const KeyPoint& to, const Vec3& shift) {
        Vec3 way = to.place + shift - from.place;
        // What a pick climbs within the cloth it does only later, when the warps press it there.
        if (from.row != KeyPoint::none && to.row != KeyPoint::none) way.z() = 0;
        return way.norm();
    };
    double length = 0;
    for (std::size_t k = 0; k + 1 < curve.keys.size(); ++k)
        length += between(curve.keys[k], curve.keys[k + 1], Vec3(0, 0, 0));
    if (curve.is_periodic) length += between(curve.keys.back(), curve.keys.front(), curve.shift);
    return length;
}

/// Makes a plan step by step; each step tells what it chose.
class Planner {
  public:
    Planner(const Design& design, const Block& block, const SimulationRequest& request)
        : m_design(design), m_block(block), m_request(request) {}

    Result<Plan> run() {
        const Resolution resolution = resolution_of(m_request.fidelity);
        m_plan.fidelity = m_request.fidelity;
        m_plan.goal = resolution.goal;
        m_plan.cloth_rows = m_block.rows();
        m_plan.cloth_columns = m_block.columns();
        m_plan.cloth_picks = m_block.picks();
        m_plan.cloth_ends = m_block.ends();
        m_plan.points_per_key = m_request.points_per_key.value_or(resolution.points_per_key);
        m_plan.scene.sample_spacing = m_request.sample_spacing.value_or(resolution.sample_spacing);
        WEAVE_CHECK_OK(check_request());
        WEAVE_CHECK_OK(check_pins(m_design.scene, m_block));
        WEAVE_CHECK_OK(lay_curves());
        WEAVE_CHECK_OK(set_boundaries());
        WEAVE_CHECK_OK(find_held());
        for (std::size_t c = 0; c < m_plan.curves.yarns.size(); ++c) add_yarn(c);
        if (m_plan.scene.yarns.empty()) return invalid("no yarn touches another, so there is nothing to simulate");
        WEAVE_CHECK_OK(check_balance());
        WEAVE_CHECK_OK(check_freedom());
        WEAVE_CHECK_OK(check_thickness());
        set_terms();
        return std::move(m_plan);
    }

  private:
    void tell(std::string term, std::string choice, std::string reason) {
        m_plan.lines.push_back({std::move(term), std::move(choice), std::move(reason)});
    }

    [[nodiscard]] Status check_request() const {
        if (!(m_plan.points_per_key >= 1 && m_plan.points_per_key <= 64))
            return Error{ErrorCode::usage, "points per crossing must be from 1 to 64", {}};
        if (!(m_plan.scene.sample_spacing > 0 && m_plan.scene.sample_spacing <= 0.45))
            return Error{ErrorCode::usage, "sample spacing must be above 0 and at most 0.45 of two radii", {}};
        return {};
    }

    Status lay_curves() {
        const CurveOptions options{m_request.region, m_request.weft_mode};
        const bool periodic = m_design.scene.boundary_x == Boundary::periodic &&
                              m_design.scene.boundary_y == Boundary::periodic && !m_request.region &&
                              m_request.weft_mode.value_or(m_design.scene.weft_mode) == WeftMode::periodic;
        std::array<std::size_t, 2> repeat{m_block.rows(), m_block.columns()};
        // A sphere acts at one place, and so does a held crossing: then no two repeats are alike.
        const bool local = !m_design.scene.fields.empty() || !m_request.held.empty();
        if (periodic && m_request.reduce && !local) repeat = smallest_repeat(m_design, m_block);
        m_plan.repeats = {m_block.rows() / repeat[0], m_block.columns() / repeat[1]};
        const std::size_t cells = m_plan.repeats[0] * m_plan.repeats[1];
        if (cells == 1) {
            WEAVE_TRY(m_plan.curves, cloth_curves(m_design, m_block, options));
            tell("repeat", "whole",
                 !periodic            ? "only a periodic cloth is its repeat"
                 : local              ? "a field or a held crossing acts at one place of the cloth"
                 : !m_request.reduce  ? "as asked for"
                                      : "the cloth has no smaller repeat");
            return {};
        }
        WEAVE_TRY(const Block small, first_repeat(m_block, repeat[0], repeat[1]));
        WEAVE_TRY(m_plan.curves, cloth_curves(m_design, small, options));
        tell("repeat", "1 of " + std::to_string(cells) + " cells",
             "rows repeat after " + std::to_string(repeat[0]) + " and columns after " + std::to_string(repeat[1]));
        return {};
    }

    Status set_boundaries() {
        m_plan.scene.is_periodic = m_plan.curves.is_periodic;
        m_plan.scene.period_mm = m_plan.curves.size_mm;
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const Boundary asked = axis == 0 ? m_design.scene.boundary_x : m_design.scene.boundary_y;
            m_rim[axis] = m_request.region ? Boundary::frozen : asked;
            const char* names[]{"periodic", "frozen", "free"};
            const std::string term = axis == 0 ? "boundary x" : "boundary y";
            if (m_request.relaxing_N_per_mm[axis]) {
                WEAVE_CHECK_OK(free_period(axis, term));
                continue;
            }
            const std::string choice = m_plan.curves.is_periodic[axis] ? "periodic"
                                       : m_rim[axis] == Boundary::periodic ? "free"
                                                                           : names[static_cast<int>(m_rim[axis])];
            tell(term, choice, m_request.region ? "a cut-out has frozen rims" : "as the scene says");
        }
        return {};
    }

    Status free_period(std::size_t axis, const std::string& term) {
        if (!m_plan.curves.is_periodic[axis])
            return invalid("a period can relax only where the piece is periodic", term);
        const double per_mm = *m_request.relaxing_N_per_mm[axis];
        m_plan.rim_force_N[axis] = per_mm * m_plan.curves.size_mm[1 - axis];
        tell(term, "periodic, relaxing",
             per_mm == 0 ? "no force pulls its rims" : "each mm of its rims is pulled with " + short_number(per_mm) + " N");
        return {};
    }

    static std::string short_number(double number) {
        char text[32];
        std::snprintf(text, sizeof text, "%g", number);
        return text;
    }

    /// The key points of held crossings, by curve.
    Status find_held() {
        m_held.resize(m_plan.curves.yarns.size());
        for (const auto& [pick, end] : m_request.held) {
            bool found = false;
            for (const Crossing& crossing : m_plan.curves.crossings) {
                if (crossing.pick != pick || crossing.end != end) continue;
                m_held[crossing.weft].push_back(crossing.weft_key);
                m_held[crossing.warp].push_back(crossing.warp_key);
                found = true;
            }
            if (!found)
                return invalid("pick " + std::to_string(pick + 1) + " and end " + std::to_string(end + 1) +
                                   " do not cross in what is simulated",
                               "pins");
        }
        return {};
    }

    /// A yarn that is loose all along is only a placeholder: nothing holds it, and it would come to rest nowhere.
    [[nodiscard]] static bool is_loose(const YarnCurve& curve) {
        return std::ranges::all_of(curve.keys, &KeyPoint::loose);
    }

    void add_yarn(std::size_t c) {
        const YarnCurve& curve = m_plan.curves.yarns[c];
        if (is_loose(curve)) {
            ++m_left_out;
            return;
        }
        const bool warp = curve.system == System::warp;
        const YarnType& type = warp ? m_design.warp.yarns[curve.type] : m_design.weft.yarns[curve.type];
        const SystemScene& system = warp ? m_design.scene.warp : m_design.scene.weft;
        const double stiffness = system.stiffness_scale.value_or(1);
        SimYarn yarn;
        yarn.is_periodic = curve.is_periodic;
        yarn.shift = curve.shift;
        yarn.turns = {curve.is_periodic && curve.shift.x() != 0 ? 1 : 0, curve.is_periodic && curve.shift.y() != 0 ? 1 : 0};
        yarn.control = control_points(curve);
        yarn.planned_mm = control_length(yarn);
        yarn.radius_mm = type.radius_mm * system.radius_scale.value_or(1);
        yarn.stretch_N = type.stretch_stiffness_N * stiffness;
        yarn.bending_N_mm2 = type.bending_stiffness_N_mm2 * stiffness;
        yarn.contact_N_mm2 = type.contact_stiffness_N_mm2;
        yarn.gram_per_mm = units::gram_per_mm(type.linear_density_tex);
        yarn.is_fed = warp || system.strain.has_value();
        yarn.strain = system.strain.value_or(usual_strain);
        yarn.rest_mm = inserted_length(curve) * (1 + weft_excess);
        yarn.frozen = frozen_points(c, yarn.control.size());
        m_plan.scene.yarns.push_back(std::move(yarn));
        m_plan.curve_of.push_back(c);
    }

    [[nodiscard]] std::vector<Vec3> control_points(const YarnCurve& curve) const {
        std::vector<Vec3> places;
        for (const KeyPoint& key : curve.keys) places.push_back(key.place);
        const Spline spline = interpolate(places, curve.is_periodic, curve.shift);
        const auto segments = static_cast<double>(spline.segments());
        const auto wanted = static_cast<std::size_t>(std::max(1.0, std::round(segments * m_plan.points_per_key)));
        return resample(spline, curve.is_periodic ? wanted : wanted + 1).control;
    }

    [[nodiscard]] std::vector<std::uint8_t> frozen_points(std::size_t c, std::size_t points) const {
        const YarnCurve& curve = m_plan.curves.yarns[c];
        const bool pinned = std::ranges::any_of(m_design.scene.pins, [&](const Pin& pin) {
            return pin.is_pick == (curve.system == System::weft) && pin.number == curve.number;
        });
        if (pinned) return std::vector<std::uint8_t>(points, 1);
        const std::size_t axis = curve.system == System::warp ? 0 : 1;
        const bool ends = !curve.is_periodic && m_rim[axis] == Boundary::frozen;
        std::vector<std::uint8_t> frozen(points, 0);
        freeze_rim(curve, frozen);
        for (std::size_t i = 0; ends && i < std::min(rim_points, points); ++i) frozen[i] = frozen[points - 1 - i] = 1;
        for (const std::size_t key : m_held[c]) hold(curve, key, frozen);
        if (std::ranges::none_of(frozen, [](std::uint8_t held) { return held != 0; })) return {};
        return frozen;
    }

    /// A frozen rim holds the yarns along it too: they would slide off the cut ends of those that they cross.
    void freeze_rim(const YarnCurve& curve, std::vector<std::uint8_t>& frozen) const {
        const Region& region = m_plan.curves.region;
        const bool rows = m_rim[0] == Boundary::frozen && !m_plan.curves.is_periodic[0],
                   columns = m_rim[1] == Boundary::frozen && !m_plan.curves.is_periodic[1];
        if (!rows && !columns) return;
        const std::size_t pieces = curve.keys.size() - (curve.is_periodic ? 0 : 1);
        const double per_key = double(frozen.size() - (curve.is_periodic ? 0 : 1)) / double(std::max<std::size_t>(1, pieces));
        for (std::size_t i = 0; i < frozen.size(); ++i) {
            const auto nearest = static_cast<std::size_t>(std::lround(static_cast<double>(i) / per_key));
            const KeyPoint& key = curve.keys[std::min(nearest, curve.keys.size() - 1)];
            if ((rows && (key.row == region.first_row || key.row == region.last_row)) ||
                (columns && (key.column == region.first_column || key.column == region.last_column)))
                frozen[i] = 1;
        }
    }

    /// Holds the place of a key point: three control points make it.
    static void hold(const YarnCurve& curve, std::size_t key, std::vector<std::uint8_t>& frozen) {
        const std::size_t points = frozen.size(), keys = curve.keys.size();
        const double per_key = curve.is_periodic ? double(points) / double(keys) : double(points - 1) / double(keys - 1);
        const auto at = static_cast<std::ptrdiff_t>(std::lround(per_key * static_cast<double>(key)));
        for (std::ptrdiff_t i = at - 1; i <= at + 1; ++i) {
            const auto n = static_cast<std::ptrdiff_t>(points);
            if (curve.is_periodic) frozen[static_cast<std::size_t>((i + n) % n)] = 1;
            if (!curve.is_periodic && i >= 0 && i < n) frozen[static_cast<std::size_t>(i)] = 1;
        }
    }

    /// A yarn fed at constant tension needs something to pull against.
    [[nodiscard]] Status check_balance() const {
        for (std::size_t y = 0; y < m_plan.scene.yarns.size(); ++y) {
            const SimYarn& yarn = m_plan.scene.yarns[y];
            if (!yarn.is_fed) continue;
            const YarnCurve& curve = m_plan.curves.yarns[m_plan.curve_of[y]];
            const bool warp = curve.system == System::warp;
            const std::string name = (warp ? "end " : "pick ") + std::to_string(curve.number + 1),
                              where = warp ? "scene.boundary_x" : "scene.boundary_y";
            const bool held = !yarn.frozen.empty() && yarn.frozen.front() != 0 && yarn.frozen.back() != 0;
            if (!yarn.is_periodic && !held)
                return invalid(name + " is fed at constant tension but its ends are free: it would shrink for ever; make the "
                                      "boundary " + (warp ? "x" : "y") + " periodic or frozen",
                               where);
            for (std::size_t axis = 0; axis < 2; ++axis) {
                if (yarn.turns[axis] != 0 && m_plan.rim_force_N[axis] && !(*m_plan.rim_force_N[axis] > 0))
                    return invalid(name + " is fed at constant tension and no force pulls the rims: the piece would shrink for "
                                          "ever; give the force, such as relaxing:0.5 N on each mm",
                                   where);
            }
        }
        return {};
    }

    /// Something must be able to move.
    [[nodiscard]] Status check_freedom() const {
        const bool moves = std::ranges::any_of(m_plan.scene.yarns, [](const SimYarn& yarn) {
            return yarn.frozen.empty() || std::ranges::count(yarn.frozen, std::uint8_t{0}) > 0;
        });
        if (moves) return {};
        if (m_request.region)
            return invalid("nothing of this part can move: its rims are held, and so are the rows and columns along them; take "
                           "at least three rows and three columns",
                           "region");
        return invalid("nothing can move: frozen rims and pins hold every yarn", "scene");
    }

    /// Yarns that are thick against their piece touch ever more of one another, and of their own images.
    [[nodiscard]] Status check_thickness() const {
        const SimScene& scene = m_plan.scene;
        Eigen::AlignedBox3d box;
        double samples = 0, thickest = 0;
        for (const SimYarn& yarn : scene.yarns) {
            for (const Vec3& point : yarn.control) box.extend(point);
            thickest = std::max(thickest, yarn.radius_mm);
            samples += std::max(static_cast<double>(yarn.control.size()), yarn.planned_mm / (scene.sample_spacing * 2 * yarn.radius_mm));
        }
        const double reach = 2 * thickest;
        double within = samples;  // of one sample
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double size = axis < 2 && scene.is_periodic[axis] ? scene.period_mm[axis] : std::max(box.sizes()[Eigen::Index(axis)], 1e-9),
                         share = 2 * reach / size;
            within *= axis < 2 && scene.is_periodic[axis] ? share : std::min(1.0, share);
        }
        if (within <= most_neighbours) return {};
        char text[200];
        std::snprintf(text, sizeof text, "yarns of %g mm radius are too thick for this piece: each place would touch some %.0e others, "
                                         "more than the %.0e that can be followed",
                      thickest, within, most_neighbours);
        return invalid(text, "scene");
    }

    void set_terms() {
        const Scene& scene = m_design.scene;
        m_plan.scene.fields = scene.fields;
        m_plan.scene.gravity_mm_ms2 = scene.gravity ? units::standard_gravity : 0;
        m_plan.scene.friction = scene.friction;
        tell("yarns", std::to_string(m_plan.scene.yarns.size()) + " of " + std::to_string(m_plan.curves.yarns.size()),
             m_left_out == 0 ? "every yarn binds somewhere" : counted(m_left_out, "yarn") + " loose all along left out");
        std::set<double> radii;
        for (const SimYarn& yarn : m_plan.scene.yarns) radii.insert(yarn.radius_mm);
        tell("radii", std::to_string(radii.size()), radii.size() == 1 ? "one grid of contact samples" : "a grid for each class of radii");
        tell("pins", m_design.scene.pins.empty() && m_request.held.empty() ? "off" : counted(m_design.scene.pins.size(), "yarn") + ", " + counted(m_request.held.size(), "crossing"),
             m_design.scene.pins.empty() && m_request.held.empty() ? "the scene has none" : "held at their planned places");
        tell("fields", scene.fields.empty() ? "off" : std::to_string(scene.fields.size()), scene.fields.empty() ? "the scene has none" : "as the scene says");
        tell("gravity", scene.gravity ? "on" : "off", "as the scene says");
        tell("friction", scene.friction > 0 ? short_number(scene.friction) : "off",
             scene.friction > 0 ? "slip counts from the start; normal forces are renewed until they agree" : "its coefficient is 0");
    }

    const Design& m_design;
    const Block& m_block;
    const SimulationRequest& m_request;
    std::array<Boundary, 2> m_rim{};
    std::vector<std::vector<std::size_t>> m_held;  ///< by curve: key points
    std::size_t m_left_out = 0;
    Plan m_plan;
};

}  // namespace

Result<Fidelity> parse_fidelity(std::string_view text) {
    for (const Fidelity fidelity : {Fidelity::draft, Fidelity::standard, Fidelity::reference}) {
        if (text == name_of(fidelity)) return fidelity;
    }
    return Error{ErrorCode::usage, "fidelity is draft, standard or reference, not '" + std::string(text) + "'", {}};
}

std::string_view name_of(Fidelity fidelity) {
    constexpr std::string_view names[]{"draft", "standard", "reference"};
    return names[static_cast<std::size_t>(fidelity)];
}

double goal_of(Fidelity fidelity) {
    return resolution_of(fidelity).goal;
}

Json lines_json(const Plan& plan) {
    Json lines = Json::array();
    for (const PlanLine& line : plan.lines)
        lines.push_back({{"term", line.term}, {"choice", line.choice}, {"reason", line.reason}});
    return lines;
}

Result<Plan> make_plan(const Design& design, const Block& block, const SimulationRequest& request) {
    return Planner(design, block, request).run();
}

}  // namespace weave::sim
