#include <weave/sim/symmetry.hpp>

#include <weave/sim/deviation.hpp>
#include <weave/sim/report_words.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace weave::sim {

namespace {

constexpr int places_a_segment = 4;

/// Greatest distance found so far, and where.
struct Worst {
    double mm = 0, radii = 0;
    const SimulatedYarn* yarn = nullptr;
    std::array<std::size_t, 2> cell{};

    void look(const Vec3& way, const SimulatedYarn& of, const std::array<std::size_t, 2>& in) {
        const double far = way.norm();
        if (far / of.radius_mm <= radii) return;
        *this = {far, far / of.radius_mm, &of, in};
    }
    /// Repeats along x and y count from 1.
    [[nodiscard]] Json json() const {
        Json json{{"max_mm", mm}, {"max_radii", radii}};
        if (yarn == nullptr) return json;
        json.update(yarn_json(*yarn));
        json["repeat"] = {cell[0] + 1, cell[1] + 1};
        return json;
    }
};

/// A cloth relaxed as a whole, cell by cell.
class Cells {
  public:
    Cells(const Plan& reduced, const Yarns& yarns) : m_yarns(yarns), m_times(reduced.repeats) {
        for (const Crossing& crossing : reduced.curves.crossings) {
            m_numbers[0] = std::max(m_numbers[0], crossing.pick + 1);
            m_numbers[1] = std::max(m_numbers[1], crossing.end + 1);
        }
        std::map<std::pair<System, std::size_t>, std::size_t> taken;
        for (const SimulatedYarn& yarn : yarns.yarns) {
            const std::pair key(yarn.system, yarn.number);
            m_nth.push_back(taken[key]++);
            m_found[{yarn.system, yarn.number, m_nth.back()}] = m_nth.size() - 1;
        }
    }

    /// Each cell against the first.
    [[nodiscard]] Worst against_first() const {
        Worst worst;
        for (std::size_t y = 0; y < m_yarns.yarns.size(); ++y) {
            const SimulatedYarn& yarn = m_yarns.yarns[y];
            const std::size_t axis = across(yarn);
            if (yarn.number >= m_numbers[axis]) continue;
            for (std::size_t i = 0; i < m_times[0]; ++i) {
                for (std::size_t j = 0; j < m_times[1]; ++j) compare(y, {i, j}, worst);
            }
        }
        return worst;
    }

    /// Everything against yarns in the same order of system and number, moved as a whole.
    [[nodiscard]] Worst against(const Yarns& other) const {
        std::vector<Spline> from, to;
        std::vector<std::size_t> of;
        std::map<std::pair<System, std::size_t>, std::size_t> taken;
        for (const SimulatedYarn& yarn : other.yarns) {
            const auto found = m_found.find({yarn.system, yarn.number, taken[{yarn.system, yarn.number}]++});
            if (found == m_found.end()) continue;
            of.push_back(found->second);
            from.push_back(m_yarns.yarns[found->second].spline);
            to.push_back(yarn.spline);
        }
        const Vec3 drift = drift_of(from, to);
        Worst worst;
        for (std::size_t k = 0; k < from.size(); ++k) {
            const SimulatedYarn& yarn = m_yarns.yarns[of[k]];
            const std::size_t axis = across(yarn), places = places_a_segment * from[k].segments();
            for (std::size_t p = 0; p < places; ++p) {
                const double share = (static_cast<double>(p) + 0.5) / static_cast<double>(places);
                std::array<std::size_t, 2> cell{};
                cell[axis] = yarn.number / m_numbers[axis];
                cell[1 - axis] =
                    std::min(m_times[1 - axis] - 1, std::size_t(share * double(m_times[1 - axis])));
                worst.look(way_across(to[k], from[k].place(share * double(from[k].segments())) + drift,
                                      share * double(to[k].segments())),
                           yarn, cell);
            }
        }
        return worst;
    }

  private:
    /// The axis across a system: x of picks, y of ends.
    static std::size_t across(const SimulatedYarn& yarn) { return yarn.system == System::weft ? 0 : 1; }

    /// The piece of a yarn in the first cell against that in another.
    void compare(std::size_t y, const std::array<std::size_t, 2>& cell, Worst& worst) const {
        const SimulatedYarn& yarn = m_yarns.yarns[y];
        const std::size_t axis = across(yarn), along = 1 - axis;
        const auto found = m_found.find({yarn.system, yarn.number + cell[axis] * m_numbers[axis], m_nth[y]});
        if (found == m_found.end()) return;
        const SimulatedYarn& there = m_yarns.yarns[found->second];
        const Vec3 shift(m_yarns.size_mm[0] * double(cell[0]) / double(m_times[0]),
                         m_yarns.size_mm[1] * double(cell[1]) / double(m_times[1]), 0);
        const double mine = double(yarn.spline.segments()) / double(m_times[along]),
                     theirs = double(there.spline.segments()) / double(m_times[along]);
        const auto places = static_cast<std::size_t>(std::ceil(places_a_segment * mine));
        for (std::size_t p = 0; p < places; ++p) {
            const double share = (static_cast<double>(p) + 0.5) / static_cast<double>(places);
            worst.look(way_across(there.spline, yarn.spline.place(share * mine) + shift,
                                  (share + double(cell[along])) * theirs),
                       there, cell);
        }
    }

    const Yarns& m_yarns;
    std::array<std::size_t, 2> m_times;
    std::array<std::size_t, 2> m_numbers{};  ///< picks and ends of one cell
    std::vector<std::size_t> m_nth;          ///< of each yarn among those of its number
    std::map<std::tuple<System, std::size_t, std::size_t>, std::size_t> m_found;
};

}  // namespace

Json compared_repeats(const Plan& reduced, const Yarns& whole, const Yarns& copied) {
    const Cells cells(reduced, whole);
    const Worst between = cells.against_first(), from_copied = cells.against(copied);
    return {{"between_repeats", between.json()},
            {"from_smallest_repeat", from_copied.json()},
            {"broken", between.radii > same_rest_radii}};
}

WholeRun relaxed_whole(const Design& design, const Plan& reduced, const Plan& whole,
                       const SimulationOptions& options, const Yarns& copied, std::uint64_t seed) {
    SimulationOptions again = options;
    again.flips.clear();
    again.start = perturbed_start(whole, std::nullopt, seed, options.threads);
    WholeRun run;
    run.yarns = simulate(design, whole, again);
    const double cells = static_cast<double>(reduced.repeats[0] * reduced.repeats[1]);
    run.symmetry = compared_repeats(reduced, run.yarns, copied);
    run.symmetry.update({{"repeats", reduced.repeats},
                         {"noise_radii", start_noise_radii},
                         {"seed", seed},
                         {"converged", run.yarns.report.at("converged")},
                         {"order_kept", run.yarns.report.at("order_kept")},
                         {"seconds", run.yarns.report.at("seconds")},
                         {"energy_N_mm", run.yarns.report.at("energy_N_mm")},
                         {"energy_of_repeats_N_mm", cells * copied.report.at("energy_N_mm").get<double>()}});
    return run;
}

std::string symmetry_text(const Json& report) {
    const Json symmetry = part_of(report, "symmetry");
    if (!symmetry.is_object()) return "";
    const Json between = part_of(symmetry, "between_repeats"),
               from = part_of(symmetry, "from_smallest_repeat"), repeat = part_of(between, "repeat");
    const double apart = number_in(between, "max_radii"), off = number_in(from, "max_radii");
    std::string text = part_of(symmetry, "broken") == true
                           ? "SYMMETRY BROKEN: relaxed as a whole from a start with noise, repeats "
                             "lie up to"
                           : "Symmetric: relaxed as a whole from a start with noise, its repeats "
                             "lie within";
    text += short_format(" %.2g radii of one another", apart);
    if (part_of(symmetry, "broken") == true) {
        text += yarn_words(between);
        if (repeat.is_array() && repeat.size() == 2 && repeat[0].is_number() && repeat[1].is_number())
            text += short_format(", furthest in repeat %.0f along the ends", repeat[0].get<double>()) +
                    short_format(" and %.0f along the picks", repeat[1].get<double>());
    }
    text += off > same_rest_radii
                ? short_format(", and another rest than the smallest repeat's, by up to %.2g radii", off)
                : short_format(", and as the smallest repeat does to %.2g radii", off);
    if (part_of(symmetry, "converged") == false) text += "; the whole did not come to rest";
    return text + "\n";
}

}  // namespace weave::sim
