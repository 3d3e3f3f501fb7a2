#include <weave/sim/result.hpp>

#include <weave/curve/drawn_by.hpp>
#include <weave/design/document.hpp>
#include <weave/design/picks.hpp>
#include <weave/sim/planned_yarns.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

namespace weave::sim {

std::uint64_t peak_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmHWM:", 0) == 0) return std::stoull(line.substr(6)) * 1024;
    }
    return 0;
}

bool is_held_at(const SimYarn& yarn, std::size_t begin) {
    return !yarn.frozen.empty() && any_that_draws(yarn.frozen.size(), yarn.is_periodic, begin, [&](std::size_t at) { return yarn.frozen[at] != 0; });
}

namespace {

std::vector<std::uint8_t> held_segments(const Fabric<double>& fabric) {
    std::vector<std::uint8_t> held;
    for (const SegmentPlace& segment : fabric.segment_places())
        held.push_back(is_held_at(fabric.scene().yarns[segment.yarn], segment.slot - fabric.yarns()[segment.yarn].first_slot) ? 1 : 0);
    return held;
}

}  // namespace

Contacts contacts_of(Energy<double>& energy, const std::vector<double>& state) {
    const FabricView<double> fabric = energy.view(state);
    const std::vector<std::uint8_t> held = held_segments(energy.fabric());
    Neighbours<double>& neighbours = energy.neighbours();
    Contacts contacts;
    std::vector<std::uint32_t> seen(energy.fabric().segments(), 0xffffffffU);
    std::size_t from_both = 0;
    for (std::uint32_t a = 0; a < energy.fabric().samples(); ++a) {
        const std::uint32_t mine = neighbours.segment_of(a);
        if (!energy.fabric().is_own(mine)) continue;
        for (std::uint32_t e = fabric.first_neighbour[a]; e < fabric.first_neighbour[a + 1]; ++e) {
            const std::uint32_t b = fabric.neighbours[e];
            const double dx = fabric.samples.x[a] - fabric.samples.x[b], dy = fabric.samples.y[a] - fabric.samples.y[b],
                         dz = fabric.samples.z[a] - fabric.samples.z[b];
            const double share = std::sqrt(dx * dx + dy * dy + dz * dz) / (fabric.samples.radius[a] + fabric.samples.radius[b]);
            if (share >= 1) continue;
            const std::uint32_t other = neighbours.segment_of(neighbours.own(b));
            if (held[mine] == 0 || held[other] == 0) contacts.overlap = std::max(contacts.overlap, 1 - share);
            std::uint32_t& last = seen[other];
            from_both += last == mine ? 0 : 1;
            last = mine;
        }
    }
    contacts.seen = from_both;
    return contacts;
}

namespace {

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
        const SimYarn& yarn = m_fabric.scene().yarns[y];
        return {std::move(control), yarn.is_periodic, yarn.shift};
    }

    [[nodiscard]] SimulatedYarn yarn(std::size_t y) const {
        const SimYarn& now = m_fabric.scene().yarns[y];  // parameters may have changed since it was planned
        const YarnCurve& curve = m_plan.curves.yarns[m_plan.curve_of[y]];
        const YarnPlace& place = m_fabric.yarns()[y];
        SimulatedYarn yarn = labelled_yarn(m_design, curve);
        yarn.radius_mm = now.radius_mm;
        yarn.spline = spline(y, {});
        for (std::size_t i = 0; i < place.points; ++i) {
            const std::size_t at = 3 * (place.first_slot + 1 + i);
            yarn.spline.control.push_back(load(&m_state[at]));
            yarn.contact_N.push_back(load(&m_contact[at]).norm());
        }
        yarn.planned = m_plan.scene.yarns[y].control;
        measure(now, place, yarn);
        return yarn;
    }

    /// Lengths, and the strain at each control point: of a fed yarn its rest length is the length over S.
    void measure(const SimYarn& now, const YarnPlace& place, SimulatedYarn& yarn) const {
        std::vector<double> rest;
        for (std::size_t s = 0; s < place.segments; ++s) {
            const Speeds<double> speeds(m_fabric.gauss(), &m_state[3 * (place.first_slot + s)]);
            yarn.length_mm += speeds.length;
            rest.push_back(now.is_fed ? speeds.length / now.strain
                                          : now.rest_mm / static_cast<double>(place.segments));
        }
        for (std::size_t i = 0; i < place.points; ++i) {
            const double speed = yarn.spline.tangent(static_cast<double>(i)).norm();
            yarn.strain.push_back(speed / rest[std::min(i, rest.size() - 1)] - 1);
        }
        yarn.rest_length_mm = now.is_fed ? yarn.length_mm / now.strain : now.rest_mm;
        yarn.planned_length_mm = now.is_periodic ? now.shift.norm() : (yarn.planned.back() - yarn.planned.front()).norm();
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
    list.reserve(once * times);
    for (std::size_t i = 0; i < once * (times - 1); ++i) list.push_back(list[i]);
}

/// The same for places, each copy a `shift` further.
void repeat(std::vector<Vec3>& places, std::size_t times, const Vec3& shift) {
    const std::size_t once = places.size();
    places.reserve(once * times);
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

/// Appends the yarns of one system over the whole cloth: `across` times side by side, each through `along` repeats.
void append_copies(std::vector<SimulatedYarn>& copies, const Yarns& repeat, System system, std::size_t across, std::size_t along,
                   std::size_t numbers, const Vec3& step, const Design& design) {
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
}

}  // namespace

Yarns yarns_in_state(const Design& design, const Plan& plan, Energy<double>& energy, const std::vector<double>& state) {
    return RelaxedRepeat(design, plan, energy, state).yarns();
}

Yarns copied_back(Yarns yarns, const Plan& plan, const Design& design) {
    const std::array<std::size_t, 2>& times = plan.repeats;
    if (times[0] * times[1] == 1) return yarns;
    // Not counted from the crossings: the last pick of a repeat may have no weft, its last end may be loose.
    const std::size_t picks = plan.cloth_picks / times[0], ends = plan.cloth_ends / times[1];
    Yarns whole = yarns;
    whole.region = {0, plan.cloth_rows - 1, 0, plan.cloth_columns - 1};
    whole.yarns.clear();
    append_copies(whole.yarns, yarns, System::weft, times[0], times[1], picks, Vec3(yarns.size_mm[0], 0, 0), design);
    const std::size_t wefts = whole.yarns.size(), weft_yarns = wefts / times[0], warp_yarns = yarns.yarns.size() - weft_yarns;
    append_copies(whole.yarns, yarns, System::warp, times[1], times[0], ends, Vec3(0, yarns.size_mm[1], 0), design);
    whole.crossings.clear();
    whole.crossings.reserve(times[0] * times[1] * yarns.crossings.size());
    for (std::size_t x = 0; x < times[0]; ++x) {
        for (std::size_t y = 0; y < times[1]; ++y) {
            for (Crossing crossing : yarns.crossings) {
                const YarnCurve &weft = plan.curves.yarns[plan.curve_of[crossing.weft]],
                                &warp = plan.curves.yarns[plan.curve_of[crossing.warp]];
                crossing.weft_key += y * weft.keys.size();
                crossing.warp_key += x * warp.keys.size();
                crossing.weft += x * weft_yarns;
                crossing.warp = wefts + y * warp_yarns + (crossing.warp - weft_yarns);
                crossing.pick += x * picks;
                crossing.end += y * ends;
                whole.crossings.push_back(crossing);
            }
        }
    }
    whole.size_mm = {yarns.size_mm[0] * static_cast<double>(times[0]), yarns.size_mm[1] * static_cast<double>(times[1])};
    return whole;
}

void CrossedYarns::add(const Crossing& crossing) {
    picks = {std::min(picks[0], crossing.pick + 1), std::max(picks[1], crossing.pick + 1)};
    ends = {std::min(ends[0], crossing.end + 1), std::max(ends[1], crossing.end + 1)};
}

Json coverage_of(const Plan& plan) {
    CrossedYarns crossed;
    for (const Crossing& crossing : plan.curves.crossings) crossed.add(crossing);
    return coverage_of(plan, crossed);
}

Json coverage_of(const Plan& plan, CrossedYarns crossed) {
    const Region& region = plan.curves.region;
    auto& [picks, ends] = crossed;
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

Json told_of_coarser(const Json& report) {
    Json coarser{{"taken", false}};
    for (const char* name : {"fidelity", "points_per_key", "points", "goal", "residual", "ending", "iterations", "seconds",
                             "energy_N_mm", "lost_crossings"})
        coarser[name] = report.at(name);
    return coarser;
}

}  // namespace weave::sim
