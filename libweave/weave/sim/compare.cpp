#include <weave/sim/compare.hpp>

#include <weave/sim/yarns_file.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>

namespace weave {

namespace {

using sim::Alignment;
using sim::CurveFinder;
using sim::OnCurve;

constexpr std::size_t looks_a_segment =
    4;  ///< places taken from each segment of a yarn that stands for a measured one
constexpr std::size_t most_samples = 4096;     ///< of one yarn
constexpr std::size_t first_samples = 32;      ///< of one yarn, for the first guess
constexpr std::size_t most_candidates = 32;    ///< simulated yarns that are tried on a measured one
constexpr std::size_t most_tries = 1'000'000;  ///< pairs of yarns that matching by nearness looks at
constexpr int fitting_rounds = 60, matching_rounds = 8;

Vec3 middle_of(const std::vector<Vec3>& places) {
    Vec3 middle(0, 0, 0);
    for (const Vec3& place : places) middle += place / static_cast<double>(places.size());
    return middle;
}
/// The other handedness must fit so much better before it is believed: most cloth is nearly its own mirror
/// image.
constexpr double clearly_better = 0.9;

/// The places of a measured yarn with the length of curve that each stands for.
struct Samples {
    std::vector<Vec3> places;
    std::vector<double> weights;
    Vec3 middle{0, 0, 0};
};

Samples samples_of(const MeasuredYarn& yarn) {
    Samples samples;
    samples.places =
        yarn.places.size() <= most_samples ? yarn.places : sim::even_places(yarn.places, most_samples);
    samples.weights.assign(samples.places.size(), 0);
    for (std::size_t i = 0; i + 1 < samples.places.size(); ++i) {
        const double half = (samples.places[i + 1] - samples.places[i]).norm() / 2;
        samples.weights[i] += half;
        samples.weights[i + 1] += half;
    }
    const double length = std::accumulate(samples.weights.begin(), samples.weights.end(), 0.0);
    for (double& weight : samples.weights)  // a yarn of no length still lies somewhere
        weight = length > 0 ? weight : 1 / static_cast<double>(samples.places.size());
    for (const Vec3& place : samples.places)
        samples.middle += place / static_cast<double>(samples.places.size());
    return samples;
}

struct Pair {
    std::size_t measured, simulated;
};

struct Fit {
    Alignment alignment;
    double rms = std::numeric_limits<double>::max();
};

class Fitter {
  public:
    Fitter(const Yarns& yarns, const MeasuredCloth& measured) : m_yarns(yarns), m_measured(measured) {
        for (const MeasuredYarn& yarn : measured.yarns) m_samples.push_back(samples_of(yarn));
        for (const SimulatedYarn& yarn : yarns.yarns) m_curves.emplace_back(yarn.spline);
    }

    /// The best alignment of these pairs. `parallel`: the axes lie along one another to begin with.
    [[nodiscard]] Fit best(const std::vector<Pair>& pairs, bool parallel) const {
        std::array<Fit, 2> fits;
        for (const bool mirrored : {false, true}) {
            std::vector<Alignment> starts{shifted(pairs, mirrored)};
            for (const bool by_middles : {false, true}) {
                if (!parallel) starts.push_back(along_the_yarns(pairs, mirrored, by_middles));
            }
            for (const Alignment& start : starts) {
                const Fit fit = fitted(pairs, start);
                if (fit.rms < fits[mirrored ? 1 : 0].rms) fits[mirrored ? 1 : 0] = fit;
            }
        }
        return fits[1].rms < clearly_better * fits[0].rms && fits[0].rms > 1e-9 * scale(pairs) ? fits[1]
                                                                                               : fits[0];
    }

    /// Pairs each measured yarn with the nearest simulated one, nearest pairs first, no yarn twice.
    [[nodiscard]] std::vector<Pair> nearest_pairs(const Alignment& alignment) const {
        std::vector<std::tuple<double, std::size_t, std::size_t>> all;
        for (std::size_t m = 0; m < m_samples.size(); ++m) {
            const std::vector<Vec3> few = sim::even_places(m_measured.yarns[m].places, first_samples);
            for (const std::size_t s : candidates(alignment(few[first_samples / 2]))) {
                const Vec3 aside = period_aside(s, alignment(m_samples[m].middle));
                double sum = 0;
                for (const Vec3& place : few) sum += m_curves[s].nearest(alignment(place) - aside).distance;
                all.emplace_back(sum, m, s);
            }
        }
        std::ranges::sort(all);
        std::vector<char> taken(m_curves.size(), 0);
        std::vector<std::optional<std::size_t>> partner(m_samples.size());
        for (const auto& [sum, m, s] : all) {
            if (partner[m] || taken[s] != 0) continue;
            partner[m] = s;
            taken[s] = 1;
        }
        std::vector<Pair> pairs;
        for (std::size_t m = 0; m < partner.size(); ++m) {
            if (partner[m]) pairs.push_back({m, *partner[m]});
        }
        return pairs;
    }

    /// Every yarn on every other: only their middles count.
    [[nodiscard]] Alignment middles(bool mirrored) const {
        Vec3 from(0, 0, 0), to(0, 0, 0);
        for (const Samples& samples : m_samples)
            from += samples.middle / static_cast<double>(m_samples.size());
        for (const CurveFinder& curve : m_curves) to += curve.middle() / static_cast<double>(m_curves.size());
        Alignment alignment;
        alignment.mirrored = mirrored;
        alignment.translation = to - alignment(from);
        return alignment;
    }

    void measure(const std::vector<Pair>& pairs, const Alignment& alignment, Comparison& comparison) const {
        double sum = 0, weights = 0;
        for (const Pair& pair : pairs) {
            YarnDeviation yarn{pair.measured, pair.simulated};
            const Samples& samples = m_samples[pair.measured];
            const Vec3 aside = period_aside(pair.simulated, alignment(samples.middle));
            double yarn_sum = 0, yarn_weights = 0;
            for (std::size_t i = 0; i < samples.places.size(); ++i) {
                const OnCurve found = m_curves[pair.simulated].nearest(alignment(samples.places[i]) - aside);
                yarn_sum += samples.weights[i] * found.distance * found.distance;
                yarn_weights += samples.weights[i];
                if (found.distance <= yarn.max_mm) continue;
                yarn.max_mm = found.distance;
                yarn.worst = found.place + aside;
            }
            yarn.rms_mm = std::sqrt(yarn_sum / yarn_weights);
            comparison.max_mm = std::max(comparison.max_mm, yarn.max_mm);
            sum += yarn_sum;
            weights += yarn_weights;
            comparison.per_yarn.push_back(yarn);
        }
        comparison.rms_mm = std::sqrt(sum / weights);
        comparison.alignment = alignment;
    }

    /// The largest radius of the simulated yarns.
    [[nodiscard]] double scale(const std::vector<Pair>& pairs) const {
        double scale = 0;
        for (const Pair& pair : pairs) scale = std::max(scale, m_yarns.yarns[pair.simulated].radius_mm);
        return scale;
    }

  private:
    /// The simulated yarns that pass nearest to a place.
    [[nodiscard]] std::vector<std::size_t> candidates(const Vec3& place) const {
        std::vector<std::pair<double, std::size_t>> all;
        for (std::size_t s = 0; s < m_curves.size(); ++s)
            all.emplace_back(m_curves[s].nearest(place - period_aside(s, place)).distance, s);
        const std::size_t count = std::min(most_candidates, all.size());
        std::ranges::partial_sort(all, all.begin() + static_cast<std::ptrdiff_t>(count));
        std::vector<std::size_t> nearest;
        for (std::size_t k = 0; k < count; ++k) nearest.push_back(all[k].second);
        return nearest;
    }

    /// Whole periods across a yarn between it and a place.
    [[nodiscard]] Vec3 period_aside(std::size_t simulated, const Vec3& place) const {
        const std::size_t axis = m_yarns.yarns[simulated].system == System::weft ? 0 : 1;
        const double period = m_yarns.size_mm[axis];
        Vec3 aside(0, 0, 0);
        if (!m_yarns.is_periodic[axis] || !(period > 0)) return aside;
        const auto at = static_cast<int>(axis);
        aside[at] = period * std::round((place[at] - m_curves[simulated].middle()[at]) / period);
        return aside;
    }

    [[nodiscard]] Alignment shifted(const std::vector<Pair>& pairs, bool mirrored) const {
        Vec3 from(0, 0, 0), to(0, 0, 0);
        for (const Pair& pair : pairs) {
            from += m_samples[pair.measured].middle / static_cast<double>(pairs.size());
            to += m_curves[pair.simulated].middle() / static_cast<double>(pairs.size());
        }
        Alignment alignment;
        alignment.mirrored = mirrored;
        alignment.translation = to - alignment(from);
        return alignment;
    }

    /// Lays yarn on yarn from end to end; those that fit better backwards are then turned round. Where many run
    /// backwards the first try can be far off: the yarns' middles, laid on one another first, know no direction.
    [[nodiscard]] Alignment along_the_yarns(const std::vector<Pair>& pairs, bool mirrored, bool by_middles) const {
        std::vector<std::vector<Vec3>> from, to;
        for (const Pair& pair : pairs) {
            from.push_back(sim::even_places(m_measured.yarns[pair.measured].places, first_samples));
            to.push_back(m_curves[pair.simulated].even_places(first_samples));
        }
        Alignment alignment;
        for (int round = 0; round < 3; ++round) {
            std::vector<Vec3> all_from, all_to;
            for (std::size_t k = 0; k < pairs.size(); ++k) {
                if (by_middles && round == 0) {
                    all_from.push_back(middle_of(from[k]));
                    all_to.push_back(middle_of(to[k]));
                    continue;
                }
                all_from.insert(all_from.end(), from[k].begin(), from[k].end());
                all_to.insert(all_to.end(), to[k].begin(), to[k].end());
            }
            alignment = sim::kabsch(all_from, all_to, mirrored);
            for (std::size_t k = 0; k < pairs.size(); ++k) {
                double forwards = 0, backwards = 0;
                for (std::size_t i = 0; i < first_samples; ++i) {
                    forwards += (alignment(from[k][i]) - to[k][i]).squaredNorm();
                    backwards += (alignment(from[k][i]) - to[k][first_samples - 1 - i]).squaredNorm();
                }
                if (backwards < forwards) std::ranges::reverse(to[k]);
            }
        }
        return alignment;
    }

    /// One step of Gauss and Newton on the distances across the curves. Returns the rms before it.
    double step(const std::vector<Pair>& pairs, Alignment& alignment) const {
        Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
        Eigen::Matrix<double, 6, 1> pull = Eigen::Matrix<double, 6, 1>::Zero();
        const Vec3 centre = alignment(m_samples[pairs.front().measured].middle);
        double sum = 0, weights = 0;
        for (const Pair& pair : pairs) {
            const Samples& samples = m_samples[pair.measured];
            const Vec3 aside = period_aside(pair.simulated, alignment(samples.middle));
            const std::size_t every = 1 + samples.places.size() / 256;
            for (std::size_t i = 0; i < samples.places.size(); i += every) {
                const Vec3 place = alignment(samples.places[i]);
                const OnCurve found = m_curves[pair.simulated].nearest(place - aside);
                const Vec3 apart = place - aside - found.place, arm = place - centre;
                const double weight = samples.weights[i];
                sum += weight * apart.squaredNorm();
                weights += weight;
                const Eigen::Matrix3d over =
                    Eigen::Matrix3d::Identity() - found.tangent * found.tangent.transpose();
                Eigen::Matrix<double, 3, 6> move;  // of the place with a small turn and shift
                move << 0, arm.z(), -arm.y(), 1, 0, 0, -arm.z(), 0, arm.x(), 0, 1, 0, arm.y(), -arm.x(), 0, 0,
                    0, 1;
                normal += weight * move.transpose() * over * move;
                pull -= weight * move.transpose() * over * apart;
            }
        }
        normal.diagonal().array() += 1e-12 * normal.trace() + std::numeric_limits<double>::min();
        const Eigen::Matrix<double, 6, 1> by = normal.ldlt().solve(pull);
        const double angle = std::min(by.head<3>().norm(), 0.5);
        if (by.allFinite()) {
            const Eigen::Matrix3d turn =
                by.head<3>().norm() > 0
                    ? Eigen::AngleAxisd(angle, by.head<3>().normalized()).toRotationMatrix()
                    : Eigen::Matrix3d::Identity();
            alignment.rotation = turn * alignment.rotation;
            alignment.translation = turn * (alignment.translation - centre) + centre + by.tail<3>();
        }
        return std::sqrt(sum / weights);
    }

    [[nodiscard]] Fit fitted(const std::vector<Pair>& pairs, Alignment alignment) const {
        Fit best;
        int waited = 0;
        for (int round = 0; round < fitting_rounds && waited < 4; ++round) {
            const Alignment before = alignment;
            const double rms = step(pairs, alignment);
            waited = rms < 0.999 * best.rms ? 0 : waited + 1;
            if (rms < best.rms) best = {before, rms};
        }
        return best;
    }

    const Yarns& m_yarns;
    const MeasuredCloth& m_measured;
    std::vector<Samples> m_samples;
    std::vector<CurveFinder> m_curves;
};

std::vector<Pair> pairs_by_name(const Yarns& yarns, const std::vector<SimulatedYarn>& names) {
    std::map<std::pair<System, std::size_t>, std::size_t> of_name;
    for (std::size_t s = 0; s < yarns.yarns.size(); ++s)
        of_name.emplace(std::pair(yarns.yarns[s].system, yarns.yarns[s].number), s);
    std::vector<Pair> pairs;
    for (std::size_t m = 0; m < names.size(); ++m) {
        const auto found = of_name.find({names[m].system, names[m].number});
        if (found == of_name.end()) continue;
        pairs.push_back({m, found->second});
        of_name.erase(found);
    }
    return pairs;
}

void list_alone(const Yarns& yarns, const MeasuredCloth& measured, Comparison& comparison) {
    std::vector<char> has_measured(measured.yarns.size(), 0), has_simulated(yarns.yarns.size(), 0);
    for (const YarnDeviation& yarn : comparison.per_yarn)
        has_measured[yarn.measured] = has_simulated[yarn.simulated] = 1;
    for (std::size_t m = 0; m < has_measured.size(); ++m) {
        if (has_measured[m] == 0) comparison.measured_alone.push_back(m);
    }
    for (std::size_t s = 0; s < has_simulated.size(); ++s) {
        if (has_simulated[s] == 0) comparison.simulated_alone.push_back(s);
    }
}

/// Matching and alignment in turn, until the pairs stay.
Fit fit_from(const Fitter& fitter, Alignment alignment, bool parallel, std::vector<Pair>& pairs,
             double worst) {
    Fit best;
    for (int round = 0; round < matching_rounds; ++round) {
        const std::vector<Pair> now = fitter.nearest_pairs(alignment);
        const Fit fit = fitter.best(now, parallel);
        alignment = fit.alignment;
        if (fit.rms >= (round == 0 ? worst : best.rms)) break;
        best = fit;
        pairs = now;
    }
    return best;
}

Fit fit_by_nearness(const Fitter& fitter, std::vector<Pair>& pairs) {
    Fit best = fit_from(fitter, fitter.middles(false), true, pairs, std::numeric_limits<double>::max());
    const Fit mirrored = fit_from(fitter, fitter.middles(true), true, pairs, clearly_better * best.rms);
    return mirrored.rms < best.rms ? mirrored : best;
}

/// Nobody asks what else would fit while yarns lie nearer than this share of a radius.
constexpr double near_enough = 0.1;
/// What else fits is told only if it more than halves the deviation: each further try fits a little better by
/// chance.
constexpr double far_better = 0.5;

/// Pairs with the alignment that fits them best.
struct Match {
    MatchedBy by = MatchedBy::order;
    std::vector<Pair> pairs;
    Fit fit;
};

Match match_by_nearness(const Fitter& fitter) {
    Match match{MatchedBy::nearness, {}, {}};
    match.fit = fit_by_nearness(fitter, match.pairs);
    return match;
}

Match match_by_order(const Fitter& fitter, std::size_t yarns) {
    Match match;
    for (std::size_t k = 0; k < yarns; ++k) match.pairs.push_back({k, k});
    match.fit = fitter.best(match.pairs, false);
    return match;
}

/// The same by nearness from where order has laid them, too: that way their axes need not be along one
/// another.
Match match_by_nearness(const Fitter& fitter, const Match& order) {
    Match match = match_by_nearness(fitter), again{MatchedBy::nearness, {}, {}};
    if (match.fit.rms < far_better * order.fit.rms) return match;
    again.fit = fit_from(fitter, order.fit.alignment, false, again.pairs, match.fit.rms);
    return again.fit.rms < match.fit.rms ? again : match;
}

bool can_be_matched_by_nearness(const Yarns& yarns, const MeasuredCloth& measured) {
    return yarns.yarns.size() <= most_tries / measured.yarns.size();
}

Result<Match> first_match(const Fitter& fitter, const Yarns& yarns, const MeasuredCloth& measured,
                          std::optional<MatchedBy> wish) {
    Match match{MatchedBy::name, wish ? std::vector<Pair>() : pairs_by_name(yarns, measured.names), {}};
    if (!match.pairs.empty()) {
        match.fit = fitter.best(match.pairs, false);
        return match;
    }
    const bool as_many = yarns.yarns.size() == measured.yarns.size();
    const std::string counts = std::to_string(measured.yarns.size()) + " measured and " +
                               std::to_string(yarns.yarns.size()) + " simulated yarns ";
    if (wish == MatchedBy::order && !as_many)
        return bad_input(counts + "cannot be matched in order: there must be as many");
    if (as_many && wish != MatchedBy::nearness) return match_by_order(fitter, yarns.yarns.size());
    if (!can_be_matched_by_nearness(yarns, measured))
        return bad_input(counts +
                         "are too many to match by nearness: give equally many, in order, or a part");
    return match_by_nearness(fitter);
}

struct Unit {
    const char* name;
    double mm;
};
constexpr Unit units[]{{"µm", 1e-3}, {"m", 1e3}, {"tenths of a mm", 0.1}, {"cm", 10}, {"inches", 25.4}};

double length_of(const std::vector<MeasuredYarn>& yarns) {
    double length = 0;
    for (const MeasuredYarn& yarn : yarns) {
        for (std::size_t k = 0; k + 1 < yarn.places.size(); ++k)
            length += (yarn.places[k + 1] - yarn.places[k]).norm();
    }
    return length / static_cast<double>(yarns.size());
}

double length_of(const std::vector<SimulatedYarn>& yarns) {
    double length = 0;
    for (const SimulatedYarn& yarn : yarns) length += yarn.length_mm;
    return length / static_cast<double>(yarns.size());
}

/// The unit in which the measured yarns fit best, if that is far better than `match` in mm. Only units that
/// give a mean length within a factor of 2 are tried.
std::optional<UnitHint> better_unit(const Yarns& yarns, const MeasuredCloth& measured, const Match& match) {
    std::optional<UnitHint> best;
    double bound = far_better * match.fit.rms;
    const double share = length_of(yarns.yarns) / length_of(measured.yarns);
    for (const auto& [name, mm] : units) {
        if (!(share / mm > 0.5 && share / mm < 2)) continue;
        MeasuredCloth scaled = measured;
        for (MeasuredYarn& yarn : scaled.yarns) {
            for (Vec3& place : yarn.places) place *= mm;
        }
        const Fitter fitter(yarns, scaled);
        std::vector<Match> tries;
        if (match.by != MatchedBy::nearness) {
            tries.push_back({match.by, match.pairs, fitter.best(match.pairs, false)});
        }
        if (can_be_matched_by_nearness(yarns, measured))
            tries.push_back(tries.empty() ? match_by_nearness(fitter) : match_by_nearness(fitter, tries[0]));
        for (const Match& other : tries) {
            if (other.fit.rms >= bound) continue;
            bound = (other.by == match.by ? 1 : far_better) * other.fit.rms;
            best = UnitHint{name, mm, other.fit.rms, other.by};
        }
    }
    return best;
}

}  // namespace

Result<MeasuredCloth> read_measured_cloth(std::string_view bytes) {
    MeasuredCloth cloth;
    if (!bytes.starts_with("weave-yarns ")) {
        WEAVE_TRY(cloth.yarns, read_measured(bytes));
        return cloth;
    }
    WEAVE_TRY(Yarns yarns, read_yarns(bytes));
    for (SimulatedYarn& yarn : yarns.yarns) {
        MeasuredYarn measured;
        const std::size_t looks = looks_a_segment * yarn.spline.segments();
        for (std::size_t k = 0; k <= looks; ++k)
            measured.places.push_back(
                yarn.spline.place(static_cast<double>(k) / static_cast<double>(looks_a_segment)));
        cloth.yarns.push_back(std::move(measured));
        cloth.names.push_back(std::move(yarn));
    }
    return cloth;
}

Result<Comparison> compare(const Yarns& yarns, const MeasuredCloth& measured, std::optional<MatchedBy> wish) {
    if (yarns.yarns.empty() || measured.yarns.empty()) return bad_input("there is no yarn to compare");
    const Fitter fitter(yarns, measured);
    WEAVE_TRY(const Match match, first_match(fitter, yarns, measured, wish));
    Comparison comparison;
    comparison.matched_by = match.by;
    fitter.measure(match.pairs, match.fit.alignment, comparison);
    list_alone(yarns, measured, comparison);
    if (comparison.rms_mm <= near_enough * fitter.scale(match.pairs)) return comparison;
    comparison.unit = better_unit(yarns, measured, match);
    if (match.by == MatchedBy::order && !comparison.unit && can_be_matched_by_nearness(yarns, measured)) {
        const Match other = match_by_nearness(fitter, match);
        Comparison nearness;
        fitter.measure(other.pairs, other.fit.alignment, nearness);
        if (nearness.rms_mm < far_better * comparison.rms_mm)
            comparison.by_nearness = {nearness.rms_mm, nearness.max_mm};
    }
    return comparison;
}

}  // namespace weave
