#include <weave/sim/plan.hpp>

#include <weave/sim/forecast.hpp>
#include <weave/sim/plan_in_stretches.hpp>
#include <weave/sim/resolution.hpp>
#include <weave/sim/yarns_file.hpp>

#include <weave/core/text.hpp>
#include <weave/core/units.hpp>
#include <weave/design/pins.hpp>
#include <weave/design/picks.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <set>

namespace weave::sim {

namespace {

/// Wefts are inserted a little longer than the cloth is wide.
constexpr double weft_excess = 0.01;
constexpr double most_neighbours = 1e4;  ///< of one contact sample, as a rough bound from above tells

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
class InsertedLength {
  public:
    explicit InsertedLength(const YarnCurve& curve) : m_curve(curve) {}
    void add(const KeyPoint& key) {
        if (m_before) m_mm += between(*m_before, key, Vec3(0, 0, 0));
        if (!m_first) m_first = key;
        m_before = key;
    }
    [[nodiscard]] double mm() const {
        if (m_curve.is_periodic && m_curve.shift.y() != 0) return m_curve.shift.norm();
        return m_mm + (m_curve.is_periodic ? between(*m_before, *m_first, m_curve.shift) : 0);
    }

  private:
    static double between(const KeyPoint& from, const KeyPoint& to, const Vec3& shift) {
        Vec3 way = to.place + shift - from.place;
        // What a pick climbs within the cloth it does only later, when the warps press it there.
        if (from.row != KeyPoint::none && to.row != KeyPoint::none) way.z() = 0;
        return way.norm();
    }
    const YarnCurve& m_curve;
    std::optional<KeyPoint> m_first, m_before;
    double m_mm = 0;
};

}  // namespace

/// Makes a plan step by step; each step tells what it chose.
class Planner {
  public:
    /// `most_at_once`: points of a yarn that may be looked at together.
    Planner(const Design& design, const Block& block, const SimulationRequest& request, std::size_t most_at_once)
        : m_design(design), m_block(block), m_request(request), m_most_at_once(most_at_once) {}

    /// Without points.
    Result<PlanInStretches> in_stretches() {
        WEAVE_CHECK_OK(run());
        return std::move(m_made);
    }

    Result<Plan> whole() {
        m_keeps_points = true;
        WEAVE_CHECK_OK(run());
        m_plan.curves = all_curves(*m_made.m_layout);
        return std::move(m_plan);
    }

  private:
    Status run() {
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
        WEAVE_CHECK_OK(lay_out());
        m_plan.curves = m_made.m_layout->bare();
        WEAVE_CHECK_OK(set_boundaries());
        WEAVE_CHECK_OK(find_held());
        make_points();
        for (std::size_t c = 0; c < m_plan.curves.yarns.size(); ++c) add_yarn(c);
        if (m_plan.scene.yarns.empty()) return invalid("no yarn touches another, so there is nothing to simulate");
        WEAVE_CHECK_OK(check_balance());
        WEAVE_CHECK_OK(check_freedom());
        WEAVE_CHECK_OK(check_thickness());
        set_terms();
        return {};
    }

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

    Status lay_out() {
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
        if (cells > 1) {
            WEAVE_TRY(Block small, first_repeat(m_block, repeat[0], repeat[1]));
            m_made.m_repeat = std::make_unique<const Block>(std::move(small));
        }
        WEAVE_TRY(ClothLayout layout, ClothLayout::make(m_design, cells > 1 ? *m_made.m_repeat : m_block, options));
        m_made.m_layout = std::make_unique<const ClothLayout>(std::move(layout));
        if (cells > 1)
            tell("repeat", "1 of " + std::to_string(cells) + " repeats",
                 "rows repeat after " + std::to_string(repeat[0]) + " and columns after " + std::to_string(repeat[1]));
        else
            tell("repeat", "whole",
                 !periodic            ? "only a periodic cloth is its repeat"
                 : local              ? "a field or a held crossing acts at one place of the cloth"
                 : !m_request.reduce  ? "as asked for"
                                      : "the cloth has no smaller repeat");
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
        if (m_request.held.empty()) return {};
        std::vector<bool> found(m_request.held.size(), false);
        for (std::size_t c = 0; c < m_plan.curves.yarns.size() && m_plan.curves.yarns[c].system == System::weft; ++c)
            m_made.m_layout->each_crossing(c, [&](const Crossing& crossing) { hold(crossing, found); });
        for (std::size_t h = 0; h < found.size(); ++h) {
            const auto& [pick, end] = m_request.held[h];
            if (!found[h])
                return invalid("pick " + std::to_string(pick + 1) + " and end " + std::to_string(end + 1) +
                                   " do not cross in what is simulated",
                               "pins");
        }
        return {};
    }

    void hold(const Crossing& crossing, std::vector<bool>& found) {
        for (std::size_t h = 0; h < found.size(); ++h) {
            if (m_request.held[h] != std::array{crossing.pick, crossing.end}) continue;
            m_held[crossing.weft].push_back(crossing.weft_key);
            m_held[crossing.warp].push_back(crossing.warp_key);
            found[h] = true;
        }
    }

    void make_points() {
        const ClothLayout& layout = *m_made.m_layout;
        std::vector<std::size_t> keys;
        for (std::size_t c = 0; c < layout.bare().yarns.size(); ++c) keys.push_back(layout.keys(c));
        const auto keys_of = [&layout](std::size_t curve, std::size_t first, std::size_t last, std::vector<KeyPoint>& to) { layout.add_keys(curve, first, last, to); };
        m_made.m_points = std::make_unique<const PlannedPoints>(m_design, layout.bare(), std::move(keys), keys_of, PlannedPoints::Held{m_rim, std::move(m_held)},
                                                                m_plan.points_per_key, m_most_at_once);
    }

    /// A yarn that is loose all along is only a placeholder: nothing holds it, and it would come to rest nowhere.
    [[nodiscard]] bool is_loose(std::size_t c) const {
        bool loose = true;
        m_made.m_points->each_key(c, [&](const KeyPoint& key) { return loose = key.loose; });
        return loose;
    }

    [[nodiscard]] double inserted_length(std::size_t c) const {
        InsertedLength length(m_plan.curves.yarns[c]);
        m_made.m_points->each_key(c, [&](const KeyPoint& key) {
            length.add(key);
            return true;
        });
        return length.mm();
    }

    void add_yarn(std::size_t c) {
        const YarnCurve& curve = m_plan.curves.yarns[c];
        if (is_loose(c)) {
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
        yarn.radius_mm = type.radius_mm * system.radius_scale.value_or(1);
        yarn.stretch_N = type.stretch_stiffness_N * stiffness;
        yarn.bending_N_mm2 = type.bending_stiffness_N_mm2 * stiffness;
        yarn.contact_N_mm2 = type.contact_stiffness_N_mm2;
        yarn.gram_per_mm = units::gram_per_mm(type.linear_density_tex);
        yarn.is_fed = warp || system.strain.has_value();
        yarn.strain = system.strain.value_or(usual_strain);
        yarn.rest_mm = inserted_length(c) * (1 + weft_excess);
        measure_points(c, yarn);
        m_plan.scene.yarns.push_back(std::move(yarn));
        m_plan.curve_of.push_back(c);
    }

    /// Length of the polygon of its control points, and what they are asked for below; keeps them where they are to be kept.
    void measure_points(std::size_t c, SimYarn& yarn) {
        const PlannedPoints& points = *m_made.m_points;
        const std::size_t count = points.count(c);
        std::size_t held = 0;
        std::array<bool, 2> are_ends_held{};
        for (std::size_t first = 0, last = 0; first < count; first = last) {
            last = first + std::min(m_most_at_once, count - first);
            const bool goes_on = yarn.is_periodic || last < count;
            std::vector<Vec3> control = points.control(c, static_cast<std::ptrdiff_t>(first), static_cast<std::ptrdiff_t>(last + (goes_on ? 1 : 0)));
            std::vector<std::uint8_t> frozen = points.frozen(c, static_cast<std::ptrdiff_t>(first), static_cast<std::ptrdiff_t>(last));
            for (std::size_t i = 0; i + 1 < control.size(); ++i) yarn.planned_mm += (control[i + 1] - control[i]).norm();
            control.resize(last - first);
            for (const Vec3& point : control) m_box.extend(point);
            held += static_cast<std::size_t>(std::ranges::count(frozen, std::uint8_t{1}));
            if (first == 0) are_ends_held[0] = frozen.front() != 0;
            if (last == count) are_ends_held[1] = frozen.back() != 0;
            if (!m_keeps_points) continue;
            yarn.control = std::move(control);
            if (held > 0) yarn.frozen = std::move(frozen);
        }
        m_are_ends_held.push_back(are_ends_held[0] && are_ends_held[1]);
        m_moves = m_moves || held < count;
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
            if (!yarn.is_periodic && !m_are_ends_held[y])
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
        if (m_moves) return {};
        if (m_request.region)
            return invalid("nothing of this part can move: its rims are held, and so are the rows and columns along them; take "
                           "at least three rows and three columns",
                           "region");
        return invalid("nothing can move: frozen rims and pins hold every yarn", "scene");
    }

    /// Yarns that are thick against their piece touch ever more of one another, and of their own images.
    [[nodiscard]] Status check_thickness() const {
        const SimScene& scene = m_plan.scene;
        double samples = 0, thickest = 0;
        for (std::size_t y = 0; y < scene.yarns.size(); ++y) {
            const SimYarn& yarn = scene.yarns[y];
            thickest = std::max(thickest, yarn.radius_mm);
            samples += std::max(static_cast<double>(m_made.points(y)), yarn.planned_mm / (scene.sample_spacing * 2 * yarn.radius_mm));
        }
        const double reach = 2 * thickest;
        double within = samples;  // of one sample
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double size = axis < 2 && scene.is_periodic[axis] ? scene.period_mm[axis] : std::max(m_box.sizes()[Eigen::Index(axis)], 1e-9),
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
    std::size_t m_most_at_once;
    bool m_keeps_points = false;  ///< then yarns are looked at as wholes
    std::array<Boundary, 2> m_rim{};
    std::vector<std::vector<std::size_t>> m_held;  ///< by curve: key points
    std::size_t m_left_out = 0;
    std::vector<bool> m_are_ends_held;  ///< of each yarn, both
    bool m_moves = false;
    PlanInStretches m_made;
    Plan& m_plan = m_made.m_plan;
    Eigen::AlignedBox3d& m_box = m_made.m_box;
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

namespace {

/// All repeats together come into one file in the end.
Status check_file_of(const Plan& plan) {
    const std::size_t repeats = plan.repeats[0] * plan.repeats[1], points = repeats * points_of(plan);
    if (repeats == 1 || points <= most_file_points) return {};
    return Error{ErrorCode::refused, "its " + std::to_string(repeats) + " repeats have " + std::to_string(points) + " control points, and a .yarns file has at most " +
                   std::to_string(most_file_points) + "; simulate a design of one of its repeats, or a part of the cloth", {}};
}

}  // namespace

Result<Plan> make_plan(const Design& design, const Block& block, const SimulationRequest& request) {
    WEAVE_TRY(Plan plan, Planner(design, block, request, std::numeric_limits<std::size_t>::max()).whole());
    WEAVE_CHECK_OK(check_file_of(plan));
    return plan;
}

Result<PlanInStretches> PlanInStretches::make(const Design& design, const Block& block, const SimulationRequest& request, std::size_t points_a_stretch) {
    return Planner(design, block, request, points_a_stretch).in_stretches();
}

}  // namespace weave::sim
