#include <weave/design/document.hpp>
#include <weave/design/edit.hpp>
#include <weave/design/outline.hpp>
#include <weave/loom/pick_table.hpp>
#include <weave/sim/flips.hpp>
#include <weave/sim/friction_rounds.hpp>
#include <weave/sim/newton.hpp>
#include <weave/sim/order.hpp>
#include <weave/sim/order_watch.hpp>
#include <weave/sim/paper.hpp>
#include <weave/sim/periods.hpp>
#include <weave/sim/simulate.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <string>

namespace weave::sim {

namespace {

/// The process's greatest memory so far in bytes; 0 where the system does not say.
std::uint64_t peak_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmHWM:", 0) == 0) return std::stoull(line.substr(6)) * 1024;
    }
    return 0;
}

struct Contacts {
    std::size_t touching = 0;  ///< pairs of segments
    double overlap = 0;        ///< greatest 1 - d/D
};

Contacts contacts_of(Energy<double>& energy, const std::vector<double>& state) {
    const FabricView<double> fabric = energy.view(state);
    Neighbours<double>& neighbours = energy.neighbours();
    Contacts contacts;
    std::vector<std::uint32_t> seen(energy.fabric().segments(), 0xffffffffU);
    std::size_t from_both = 0;
    for (std::uint32_t a = 0; a < energy.fabric().samples(); ++a) {
        const std::uint32_t mine = neighbours.segment_of(a);
        for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
            const std::uint32_t b = fabric.neighbours[e];
            const double dx = fabric.samples.x[a] - fabric.samples.x[b], dy = fabric.samples.y[a] - fabric.samples.y[b],
                         dz = fabric.samples.z[a] - fabric.samples.z[b];
            const double share = std::sqrt(dx * dx + dy * dy + dz * dz) / (fabric.samples.radius[a] + fabric.samples.radius[b]);
            if (share >= 1) continue;
            contacts.overlap = std::max(contacts.overlap, 1 - share);
            std::uint32_t& last = seen[neighbours.segment_of(neighbours.own(b))];
            from_both += last == mine ? 0 : 1;
            last = mine;
        }
    }
    contacts.touching = from_both / 2;
    return contacts;
}

/// The relaxed repeat becomes yarns with what is known of each.
class RelaxedRepeat {
  public:
    RelaxedRepeat(const Design& design, const Plan& plan, Energy<double>& energy, const std::vector<double>& state)
        : m_design(design), m_plan(plan), m_fabric(energy.fabric()), m_state(state) {
        energy.evaluate(state, m_contact, {.elastic = false, .contact = true});
    }

    [[nodiscard]] Yarns yarns() const {
        Yarns yarns;
        yarns.title = m_design.title;
        yarns.design_sha256 = weave::design_sha256(m_design);
        yarns.scene_sha256 = weave::scene_sha256(m_design);
        yarns.size_mm = m_plan.curves.size_mm;
        yarns.is_periodic = m_plan.curves.is_periodic;
        yarns.region = m_plan.curves.region;
        yarns.cloth_rows = m_plan.cloth_rows;
        yarns.cloth_columns = m_plan.cloth_columns;
        std::vector<std::size_t> index_of_curve(m_plan.curves.yarns.size(), m_plan.curve_of.size());
        for (std::size_t y = 0; y < m_plan.curve_of.size(); ++y) {
            index_of_curve[m_plan.curve_of[y]] = y;
            yarns.yarns.push_back(yarn(y));
        }
        for (Crossing crossing : m_plan.curves.crossings) {
            crossing.weft = index_of_curve[crossing.weft];
            crossing.warp = index_of_curve[crossing.warp];
            if (crossing.weft < m_plan.curve_of.size() && crossing.warp < m_plan.curve_of.size())
                yarns.crossings.push_back(crossing);
        }
        return yarns;
    }

  private:
    [[nodiscard]] Spline spline(std::size_t y, std::vector<Vec3> control) const {
        const SimYarn& yarn = m_plan.scene.yarns[y];
        return {std::move(control), yarn.is_periodic, yarn.shift};
    }

    [[nodiscard]] SimulatedYarn yarn(std::size_t y) const {
        const SimYarn& planned = m_plan.scene.yarns[y];
        const YarnCurve& curve = m_plan.curves.yarns[m_plan.curve_of[y]];
        const YarnPlace& place = m_fabric.yarns()[y];
        const bool warp = curve.system == System::warp;
        SimulatedYarn yarn;
        yarn.system = curve.system;
        yarn.number = curve.number;
        yarn.beam = warp ? m_design.warp.beam_order.at(curve.number) : 0;
        yarn.radius_mm = planned.radius_mm;
        yarn.colour = warp ? colour_of_end(m_design, curve.number) : m_design.weft.yarns[curve.type].colour;
        yarn.spline = spline(y, {});
        for (std::size_t i = 0; i < place.points; ++i) {
            const std::size_t at = 3 * (place.first_slot + 1 + i);
            yarn.spline.control.push_back(load(&m_state[at]));
            yarn.contact_N.push_back(load(&m_contact[at]).norm());
        }
        yarn.planned = planned.control;
        measure(planned, place, yarn);
        return yarn;
    }

    /// Lengths, and the strain at each control point: of a fed yarn its rest length is the length over S.
    void measure(const SimYarn& planned, const YarnPlace& place, SimulatedYarn& yarn) const {
        std::vector<double> rest;
        for (std::size_t s = 0; s < place.segments; ++s) {
            const Speeds<double> speeds(m_fabric.gauss(), &m_state[3 * (place.first_slot + s)]);
            yarn.length_mm += speeds.length;
            rest.push_back(planned.is_fed ? speeds.length / planned.strain
                                          : planned.rest_mm / static_cast<double>(place.segments));
        }
        for (std::size_t i = 0; i < place.points; ++i) {
            const double speed = yarn.spline.tangent(static_cast<double>(i)).norm();
            yarn.strain.push_back(speed / rest[std::min(i, rest.size() - 1)] - 1);
        }
        yarn.rest_length_mm = planned.is_fed ? yarn.length_mm / planned.strain : planned.rest_mm;
        yarn.planned_length_mm = planned.is_periodic ? planned.shift.norm()
                                                     : (planned.control.back() - planned.control.front()).norm();
    }

    const Design& m_design;
    const Plan& m_plan;
    const Fabric<double>& m_fabric;
    const std::vector<double>& m_state;
    std::vector<double> m_contact;
};

/// Appends copies of a list to itself until it is `times` as long.
void repeat(std::vector<double>& list, std::size_t times) {
    const std::size_t once = list.size();
    for (std::size_t i = 0; i < once * (times - 1); ++i) list.push_back(list[i]);
}

/// The same for places, each copy a `shift` further.
void repeat(std::vector<Vec3>& places, std::size_t times, const Vec3& shift) {
    const std::size_t once = places.size();
    for (std::size_t i = 0; i < once * (times - 1); ++i) places.push_back(places[i] + shift);
}

/// A yarn of one repeat goes on through `times` repeats.
void lengthen(SimulatedYarn& yarn, std::size_t times) {
    repeat(yarn.spline.control, times, yarn.spline.shift);
    repeat(yarn.planned, times, yarn.spline.shift);
    repeat(yarn.strain, times);
    repeat(yarn.contact_N, times);
    const auto factor = static_cast<double>(times);
    yarn.spline.shift *= factor;
    yarn.length_mm *= factor;
    yarn.rest_length_mm *= factor;
    yarn.planned_length_mm *= factor;
}

void move(SimulatedYarn& yarn, const Vec3& by) {
    for (std::vector<Vec3>* places : {&yarn.spline.control, &yarn.planned}) {
        for (Vec3& place : *places) place += by;
    }
}

/// The yarns of one system over the whole cloth: `across` times side by side, each through `along` repeats.
std::vector<SimulatedYarn> copies_of(const Yarns& repeat, System system, std::size_t across, std::size_t along,
                                     std::size_t numbers, const Vec3& step, const Design& design) {
    std::vector<SimulatedYarn> copies;
    for (std::size_t k = 0; k < across; ++k) {
        for (SimulatedYarn copy : repeat.yarns) {
            if (copy.system != system) continue;
            copy.number += k * numbers;
            if (system == System::warp) {
                copy.beam = design.warp.beam_order.at(copy.number);
                copy.colour = colour_of_end(design, copy.number);
            }
            move(copy, static_cast<double>(k) * step);
            lengthen(copy, along);
            copies.push_back(std::move(copy));
        }
    }
    return copies;
}

/// Copies a repeat back over the whole cloth.
Yarns copied_back(Yarns yarns, const Plan& plan, const Design& design) {
    const std::array<std::size_t, 2>& times = plan.repeats;
    if (times[0] * times[1] == 1) return yarns;
    // Not counted from the crossings: the last pick of a repeat may have no weft, its last end may be loose.
    const std::size_t picks = plan.cloth_picks / times[0], ends = plan.cloth_ends / times[1];
    const std::vector<SimulatedYarn> wefts = copies_of(yarns, System::weft, times[0], times[1], picks,
                                                       Vec3(yarns.size_mm[0], 0, 0), design),
                                     warps = copies_of(yarns, System::warp, times[1], times[0], ends,
                                                       Vec3(0, yarns.size_mm[1], 0), design);
    Yarns whole = yarns;
    whole.region = {0, plan.cloth_rows - 1, 0, plan.cloth_columns - 1};
    whole.yarns = wefts;
    whole.yarns.insert(whole.yarns.end(), warps.begin(), warps.end());
    whole.crossings.clear();
    const std::size_t weft_yarns = wefts.size() / times[0], warp_yarns = warps.size() / times[1];
    for (std::size_t x = 0; x < times[0]; ++x) {
        for (std::size_t y = 0; y < times[1]; ++y) {
            for (Crossing crossing : yarns.crossings) {
                const YarnCurve &weft = plan.curves.yarns[plan.curve_of[crossing.weft]],
                                &warp = plan.curves.yarns[plan.curve_of[crossing.warp]];
                crossing.weft_key += y * weft.keys.size();
                crossing.warp_key += x * warp.keys.size();
                crossing.weft += x * weft_yarns;
                crossing.warp = wefts.size() + y * warp_yarns + (crossing.warp - weft_yarns);
                crossing.pick += x * picks;
                crossing.end += y * ends;
                whole.crossings.push_back(crossing);
            }
        }
    }
    whole.size_mm = {yarns.size_mm[0] * static_cast<double>(times[0]), yarns.size_mm[1] * static_cast<double>(times[1])};
    return whole;
}

/// What of the cloth the yarns cover, first and last from 1, once a repeat has been copied back over it.
Json coverage_of(const Plan& plan) {
    const Region& region = plan.curves.region;
    std::array<std::size_t, 2> picks{SIZE_MAX, 0}, ends{SIZE_MAX, 0};
    for (const Crossing& crossing : plan.curves.crossings) {
        picks = {std::min(picks[0], crossing.pick + 1), std::max(picks[1], crossing.pick + 1)};
        ends = {std::min(ends[0], crossing.end + 1), std::max(ends[1], crossing.end + 1)};
    }
    const std::array<std::size_t, 2> rows{region.first_row + 1, (region.last_row + 1) * plan.repeats[0]},
        columns{region.first_column + 1, (region.last_column + 1) * plan.repeats[1]};
    Json coverage{{"rows", rows}, {"columns", columns}, {"repeats", {plan.repeats[0], plan.repeats[1]}}};
    picks[1] += (plan.repeats[0] - 1) * (plan.cloth_picks / plan.repeats[0]);
    ends[1] += (plan.repeats[1] - 1) * (plan.cloth_ends / plan.repeats[1]);
    if (picks[0] <= picks[1]) coverage["picks"] = picks, coverage["ends"] = ends;
    coverage["of"] = {{"rows", plan.cloth_rows}, {"columns", plan.cloth_columns},
                      {"picks", plan.cloth_picks}, {"ends", plan.cloth_ends}};
    coverage["whole"] = rows[0] == 1 && rows[1] == plan.cloth_rows && columns[0] == 1 && columns[1] == plan.cloth_columns;
    return coverage;
}

constexpr std::string_view solver_names[]{"relax", "paper"};

/// Why a run ended before it was done, by the name of its ending.
std::string why_over(std::string_view ending) {
    return ending == "time" ? "the time was up" : ending == "iterations" ? "the steps were used up" : "it was stopped";
}

/// The plan, as it is at the end of a simulation, becomes yarns with a report.
class Simulation {
  public:
    Simulation(const Design& design, const Plan& plan, const SimulationOptions& options)
        : m_design(design), m_plan(plan), m_options(options), m_executor(options.threads), m_scene(plan.scene) {}

    Yarns run() {
        if (m_options.start) m_scene = scene_at(m_plan, *m_options.start);
        if (m_options.coarser != nullptr) {
            if (std::optional<Yarns> ended = begin_coarser()) return std::move(*ended);
        }
        relax_scene();
        m_scene.slip_from.reset();  // what follows begins anew
        for (const Flip& flip : m_options.flips) make(flip);
        return measured();
    }

  private:
    /// Relaxes the coarser plan and takes its yarns over; gives them where the run ends with them.
    std::optional<Yarns> begin_coarser() {
        SimulationOptions options = m_options;
        options.residual.reset();
        options.flips.clear();
        options.coarser = nullptr;
        Simulation coarser(m_design, *m_options.coarser, options);
        Yarns yarns = coarser.run();
        yarns.report["goes_on"] = std::string(sim::name_of(m_plan.fidelity));
        m_seconds = coarser.m_seconds;
        m_iterations = coarser.m_iterations;
        m_evaluations = coarser.m_evaluations;
        m_coarser = {{"taken", false}};
        for (const char* name : {"fidelity", "points_per_key", "points", "goal", "residual", "ending", "iterations", "seconds",
                                 "energy_N_mm", "lost_crossings"})
            m_coarser[name] = yarns.report.at(name);
        m_last.ending = coarser.m_last.ending;
        if (const std::optional<Ending> over = cut_short()) return cut_off(std::move(yarns), *over);
        if (m_options.after_coarser && !m_options.after_coarser(yarns)) return cut_off(std::move(yarns), Ending::stopped);
        const std::optional<StartState> start =
            refined_start(m_plan, *m_options.coarser, {controls_of(coarser.m_scene), coarser.m_scene.period_mm});
        m_coarser["taken"] = start.has_value();
        if (!start) return {};
        m_scene = scene_at(m_plan, *start);
        // Both levels are one way from the plan to the rest.
        if (m_scene.friction > 0) m_scene.slip_from = SlipStart{controls_of(m_plan.scene), m_plan.scene.period_mm};
        return {};
    }

    /// The coarser yarns as the end of a run: whether or not they are at rest, what was asked for is not.
    Yarns cut_off(Yarns yarns, Ending ending) {
        yarns.report.update({{"converged", false},
                             {"ending", std::string(sim::name_of(ending))},
                             {"goal", goal()},
                             {"coarser", m_coarser}});
        if (!m_options.flips.empty()) yarns.report["flips"] = flips_not_begun(m_options.flips, sim::name_of(ending));
        return yarns;
    }

    /// What leaves no more to be done, if anything does: whoever watches, or the time or the steps that are used up.
    [[nodiscard]] std::optional<Ending> cut_short() const {
        if (m_cut) return m_cut;
        if (m_last.ending == Ending::stopped || m_last.ending == Ending::time) return m_last.ending;
        if (m_seconds >= m_options.most_seconds) return Ending::time;
        if (m_iterations >= m_options.most_iterations) return Ending::iterations;
        return {};
    }

    [[nodiscard]] double goal() const { return m_options.residual.value_or(m_plan.goal); }

    static std::vector<std::vector<Vec3>> controls_of(const SimScene& scene) {
        std::vector<std::vector<Vec3>> control;
        for (const SimYarn& yarn : scene.yarns) control.push_back(yarn.control);
        return control;
    }

    [[nodiscard]] RelaxOptions relax_options() const {
        RelaxOptions options;
        options.residual = goal();
        options.most_iterations = m_options.most_iterations - std::min(m_options.most_iterations, m_iterations);
        options.most_seconds = m_options.most_seconds - m_seconds;
        options.watch = m_options.watch;
        return options;
    }

    /// The same, while `m_state` is what relaxes: whoever watches is told now and then whether crossings lie in order.
    [[nodiscard]] RelaxOptions looking_on(OrderWatch& looks) const {
        RelaxOptions options = relax_options();
        if (!m_options.watch) return options;
        const auto now = [began = std::chrono::steady_clock::now()] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
        };
        options.watch = [this, &looks, now, lost = std::optional<std::size_t>()](Progress progress) mutable {
            if (const double began = now(); looks.is_due(began)) {
                lost = lost_crossings(m_plan.curves, splines_of(m_fabric->control(m_state))).size();
                looks.looked(began, now());
            }
            progress.lost_crossings = lost;
            return m_options.watch(progress);
        };
        return options;
    }

    /// Brings the scene to rest, its periods too where they relax.
    void relax_scene() {
        const bool periods = m_plan.rim_force_N[0].has_value() || m_plan.rim_force_N[1].has_value();
        if (periods) {
            m_periods = relax_periods(m_scene, m_plan.rim_force_N, relax_options(), rim_tolerance, m_executor);
            m_last = m_periods->last;
            m_friction = m_periods->friction;
        }
        m_fabric = std::make_unique<Fabric<double>>(m_scene);
        m_energy = std::make_unique<Energy<double>>(*m_fabric, m_executor);
        m_state = m_fabric->state();
        if (!periods) {
            OrderWatch looks(m_plan.curves.crossings.size());
            m_friction = relax_with_friction(*m_energy, m_state, looking_on(looks), [&](auto& energy, auto& state, const auto& options) {
                return m_options.solver == Solver::relax ? relax(energy, state, options) : relax_in_time(energy, state, options);
            });
            m_last = m_friction.last;
            m_last.seconds -= looks.spent_s();  // which relaxed nothing
        }
        std::vector<std::vector<Vec3>> control = m_fabric->control(m_state);
        for (std::size_t y = 0; y < control.size(); ++y) m_scene.yarns[y].control = std::move(control[y]);
        m_seconds += m_last.seconds;
        m_iterations += m_last.iterations;
        m_evaluations += m_last.evaluations;
    }

    [[nodiscard]] std::size_t lost() const { return lost_crossings(m_plan.curves, splines()).size(); }

    [[nodiscard]] std::vector<Spline> splines() const { return splines_of(controls_of(m_scene)); }

    /// Of control points of every yarn of the scene: one for each planned curve.
    [[nodiscard]] std::vector<Spline> splines_of(std::vector<std::vector<Vec3>> control) const {
        std::vector<Spline> splines(m_plan.curves.yarns.size());
        for (std::size_t y = 0; y < m_scene.yarns.size(); ++y)
            splines[m_plan.curve_of[y]] = {std::move(control[y]), m_scene.yarns[y].is_periodic, m_scene.yarns[y].shift};
        return splines;
    }

    /// One flip with the relaxation that follows; undone where the cloth does not take it.
    void make(const Flip& flip) {
        if (const std::optional<Ending> over = cut_short()) {
            m_flips.push_back(flips_not_begun({flip}, sim::name_of(*over)).at(0));
            return;
        }
        if (std::string reason = why_not(flip); !reason.empty()) {
            tell_of(flip, false, std::move(reason), 0, 0);
            return;
        }
        lead(flip);
    }

    /// Whether a flip under way may go on; else `m_cut` says what broke it off.
    bool may_go_on(double flip_seconds) {
        if (m_options.watch && !m_options.watch({})) m_cut = Ending::stopped;
        else if (m_seconds + flip_seconds > m_options.most_seconds) m_cut = Ending::time;
        return !m_cut;
    }

    void lead(const Flip& flip) {
        const SimScene before = m_scene;
        const std::vector<Crossing> crossings = m_plan.curves.crossings;
        const std::size_t lost_before = lost();
        const std::function<bool()> go_on = [&, began = std::chrono::steady_clock::now()] {
            return may_go_on(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
        };
        FlipResult result = flip_relaxed(m_scene, m_plan.curves, m_plan.curve_of, flip, goal(), m_executor, go_on);
        if (m_cut && !result.done) result.reason = "broken off, as " + why_over(sim::name_of(*m_cut));
        m_seconds += result.seconds;
        m_iterations += result.iterations;
        const double flip_seconds = result.seconds;
        double settle_seconds = 0;
        if (result.done) {
            relax_scene();
            settle_seconds = m_last.seconds;
            if (lost() > lost_before) {
                result.done = false;
                result.reason = "other crossings would change with it";
                m_scene = before;
                m_plan.curves.crossings = crossings;
                relax_scene();
            }
        }
        if (result.done && !apply_edit(m_design, PutFlip{m_design.root, flip})) {
            result.done = false;
            result.reason = "the design does not take it";
        }
        tell_of(flip, result.done, result.reason, flip_seconds, settle_seconds);
    }

    /// Why the card of the design, with the flips made so far, does not take this one; empty where it does.
    [[nodiscard]] std::string why_not(const Flip& flip) const {
        const Result<Outline> cloth = outline(m_design, CardPlace{flip.pick, flip.end});
        if (!cloth) return cloth.error().text();
        if (!cloth->at) return no_crossing(cloth->grid, flip.pick, flip.end).message;
        const PlacedStack& at = *cloth->at;
        if (at.stack.weft_over(flip.pick - at.first_pick, flip.end - at.first_end) == flip.weft_over)
            return "they lie so already";
        const Result<Stack> flipped = weave::flip(at, flip.pick, flip.end);
        return flipped ? "" : flipped.error().message;
    }

    void tell_of(const Flip& flip, bool done, std::string reason, double flip_seconds, double settle_seconds) {
        m_flips.push_back({{"pick", flip.pick + 1}, {"end", flip.end + 1}, {"weft_over", flip.weft_over},
                           {"done", done}, {"tried", done || !m_cut}, {"reason", std::move(reason)}, {"flip_seconds", flip_seconds},
                           {"settle_seconds", settle_seconds}, {"settle_iterations", done ? m_last.iterations : 0}});
    }

    /// The planned places in the periods reached, so that whoever compares them with the yarns looks at the same
    /// cloth: what the yarns say of themselves is that of these periods.
    void plan_in_periods_reached() {
        ClothCurves& curves = m_plan.curves;
        Vec3 grown(1, 1, 1);
        for (std::size_t k = 0; k < 2; ++k) {
            if (!m_scene.is_periodic[k]) continue;
            grown[static_cast<int>(k)] = m_scene.period_mm[k] / curves.size_mm[k];
            curves.size_mm[k] = m_scene.period_mm[k];
        }
        for (YarnCurve& curve : curves.yarns) {
            for (KeyPoint& key : curve.keys) key.place = key.place.cwiseProduct(grown);
            curve.shift = curve.shift.cwiseProduct(grown);
        }
        for (SimYarn& yarn : m_plan.scene.yarns) {
            for (Vec3& place : yarn.control) place = place.cwiseProduct(grown);
            yarn.shift = yarn.shift.cwiseProduct(grown);
        }
    }

    Yarns measured() {
        plan_in_periods_reached();
        const RelaxedRepeat result(m_design, m_plan, *m_energy, m_state);
        const Contacts contacts = contacts_of(*m_energy, m_state);
        const CrossingOrder order = crossing_order(m_plan.curves, splines());
        Yarns repeat = result.yarns();
        const Json deviation = strain_deviation(repeat);
        Yarns yarns = copied_back(std::move(repeat), m_plan, m_design);
        const bool balanced = !m_periods || m_periods->balanced;
        yarns.report = {{"design_sha256", yarns.design_sha256},
                        {"scene_sha256", yarns.scene_sha256},
                        {"coverage", coverage_of(m_plan)},
                        {"solver", std::string(sim::name_of(m_options.solver))},
                        {"backend", "cpu"},
                        {"fidelity", std::string(sim::name_of(m_plan.fidelity))},
                        {"points_per_key", m_plan.points_per_key},
                        {"converged", m_last.ending == Ending::converged && balanced},
                        {"ending", m_last.ending == Ending::converged && !balanced ? "periods" : std::string(sim::name_of(m_last.ending))},
                        {"goal", goal()},
                        {"residual", m_last.residual},
                        {"reference_N", m_last.reference_N},
                        {"energy_N_mm", m_last.energy},
                        {"points", m_fabric->points()},
                        {"contacts", contacts.touching},
                        {"iterations", m_iterations},
                        {"evaluations", m_evaluations},
                        {"seconds", m_seconds},
                        {"smallest_curvature", smallest_curvature()},
                        {"strain_deviation", deviation},
                        {"order_kept", order.lost.empty()},
                        {"crossings", m_plan.curves.crossings.size()},
                        {"lost_crossings", order.lost.size()},
                        {"slid_crossings", order.slid.size()},
                        {"max_overlap", contacts.overlap},
                        {"plan", lines_json(m_plan)},
                        {"peak_bytes", peak_bytes()}};
        if (!m_options.flips.empty()) yarns.report["flips"] = m_flips;
        if (!m_coarser.is_null()) yarns.report["coarser"] = m_coarser;
        if (m_scene.friction > 0) {
            yarns.report["friction"] = {{"coefficient", m_scene.friction}, {"rounds", m_friction.rounds},
                                        {"agreed", m_friction.agreed}, {"press_N", m_friction.slip.press_N},
                                        {"stuck_share", m_friction.slip.stuck_share},
                                        {"farthest_slip_mm", m_friction.slip.farthest_mm}};
        }
        if (m_periods) {
            const auto asked = [&](std::size_t k) { return m_plan.rim_force_N[k] ? Json(*m_plan.rim_force_N[k]) : Json(); };
            yarns.report["periods"] = {{"size_mm", m_plan.curves.size_mm}, {"force_N", m_periods->force_N},
                                       {"asked_N", {asked(0), asked(1)}},
                                       {"rounds", m_periods->rounds}, {"balanced", m_periods->balanced}};
        }
        return yarns;
    }

    /// Sign of the least second derivative of the energy at rest, where the residual does not leave it open. What is not at
    /// rest is not looked at.
    std::string smallest_curvature() {
        if (m_last.ending != Ending::converged) return "not looked";
        if (m_last.curves_down == false) return "positive";
        const Bend bend = bend_at(*m_energy, m_state, goal() * m_last.reference_N);
        return bend == Bend::up ? "positive" : bend == Bend::down ? "negative" : "unclear";
    }

    /// How far the strain of the yarns of each system is from what was asked for: S - 1 where they are fed, else 0.
    Json strain_deviation(const Yarns& repeat) const {
        std::array<double, 2> greatest{};
        for (std::size_t y = 0; y < repeat.yarns.size(); ++y) {
            const SimYarn& planned = m_plan.scene.yarns[y];
            double& most = greatest[repeat.yarns[y].system == System::warp ? 0 : 1];
            for (const double strain : repeat.yarns[y].strain)
                most = std::max(most, std::abs(strain - (planned.is_fed ? planned.strain - 1 : 0)));
        }
        return {{"warp", greatest[0]}, {"weft", greatest[1]}};
    }

    /// How near the force on a rim must come to what was asked for, as a share of the reference force of each yarn.
    static constexpr double rim_tolerance = 1e-2;

    Design m_design;
    Plan m_plan;
    const SimulationOptions& m_options;
    Executor m_executor;
    SimScene m_scene;  ///< as it lies now
    std::unique_ptr<Fabric<double>> m_fabric;
    std::unique_ptr<Energy<double>> m_energy;
    std::vector<double> m_state;
    RelaxResult m_last;
    FrictionResult m_friction;
    std::optional<PeriodsResult> m_periods;
    std::optional<Ending> m_cut;  ///< what broke a flip off
    Json m_flips = Json::array(), m_coarser;
    double m_seconds = 0;
    std::size_t m_iterations = 0, m_evaluations = 0;
};

}  // namespace

Result<Solver> parse_solver(std::string_view text) {
    for (const Solver solver : {Solver::relax, Solver::paper}) {
        if (text == name_of(solver)) return solver;
    }
    return Error{ErrorCode::usage, "solver is relax or paper, not '" + std::string(text) + "'", {}};
}

std::string_view name_of(Solver solver) {
    return solver_names[static_cast<std::size_t>(solver)];
}

Json flips_not_begun(const std::vector<Flip>& flips, std::string_view ending) {
    Json list = Json::array();
    for (const Flip& flip : flips) {
        list.push_back({{"pick", flip.pick + 1}, {"end", flip.end + 1}, {"weft_over", flip.weft_over}, {"done", false},
                        {"tried", false}, {"reason", "not begun, as " + why_over(ending)}, {"flip_seconds", 0.0},
                        {"settle_seconds", 0.0}, {"settle_iterations", 0}});
    }
    return list;
}

Yarns simulate(const Design& design, const Plan& plan, const SimulationOptions& options) {
    return Simulation(design, plan, options).run();
}

}  // namespace weave::sim
