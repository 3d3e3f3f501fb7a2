#include <weave/sim/strands.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace weave::sim {

namespace {

constexpr double most_points_per_key = 64;

Result<double> points_per_key(const Yarns& yarns) {
    const auto found = yarns.report.find("points_per_key");
    if (found == yarns.report.end() || !found->is_number() || !(found->get<double>() >= 0.5) ||
        found->get<double>() > most_points_per_key)
        return bad_input("must be a number from 0.5 to 64, or nobody knows where the yarns cross",
                         "report.points_per_key");
    return found->get<double>();
}

/// Whether a yarn is long enough to have this key point; half a control point is lost to rounding.
bool has_key(const Spline& spline, double at) {
    return at <= static_cast<double>(spline.segments()) + 0.5;
}

Vec3 at(const Spline& spline, double t) {
    return spline.place(spline.is_periodic ? t : std::min(t, static_cast<double>(spline.segments())));
}

/// Tarjan's strongly connected components, without recursion: a cloth may have 262,144 yarns.
class SheetFinder {
  public:
    explicit SheetFinder(const Yarns& yarns)
        : m_first(yarns.yarns.size() + 1, 0), m_sheet(yarns.yarns.size(), none) {
        for (const Crossing& crossing : yarns.crossings) ++m_first[lower(crossing) + 1];
        std::partial_sum(m_first.begin(), m_first.end(), m_first.begin());
        m_above.resize(yarns.crossings.size());
        std::vector<std::size_t> next(m_first.begin(), m_first.end() - 1);
        for (const Crossing& crossing : yarns.crossings)
            m_above[next[lower(crossing)]++] = crossing.weft_over ? crossing.weft : crossing.warp;
    }

    std::vector<std::size_t> run() {
        m_order.assign(m_sheet.size(), none);
        m_low.resize(m_sheet.size());
        for (std::size_t yarn = 0; yarn < m_sheet.size(); ++yarn) {
            if (m_order[yarn] == none) visit(yarn);
        }
        for (std::size_t& sheet : m_sheet)
            sheet = m_sheets - 1 - sheet;  // a component is closed after those above it
        return m_sheet;
    }

  private:
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    static std::size_t lower(const Crossing& crossing) {
        return crossing.weft_over ? crossing.warp : crossing.weft;
    }

    void enter(std::size_t yarn) {
        m_order[yarn] = m_low[yarn] = m_seen++;
        m_open.push_back(yarn);
        m_way.push_back({yarn, m_first[yarn]});
    }

    void visit(std::size_t start) {
        enter(start);
        while (!m_way.empty()) {
            const std::size_t yarn = m_way.back().yarn;
            if (m_way.back().edge < m_first[yarn + 1]) {
                const std::size_t to = m_above[m_way.back().edge++];
                if (m_order[to] == none) {
                    enter(to);
                } else if (m_sheet[to] == none) {
                    m_low[yarn] = std::min(m_low[yarn], m_order[to]);
                }
                continue;
            }
            m_way.pop_back();
            if (!m_way.empty()) m_low[m_way.back().yarn] = std::min(m_low[m_way.back().yarn], m_low[yarn]);
            if (m_low[yarn] == m_order[yarn]) close(yarn);
        }
    }

    void close(std::size_t root) {
        std::size_t yarn = none;
        while (yarn != root) {
            yarn = m_open.back();
            m_open.pop_back();
            m_sheet[yarn] = m_sheets;
        }
        ++m_sheets;
    }

    struct Step {
        std::size_t yarn, edge;
    };
    std::vector<std::size_t> m_first, m_above, m_sheet, m_order, m_low, m_open;
    std::vector<Step> m_way;
    std::size_t m_seen = 0, m_sheets = 0;
};

}  // namespace

Result<std::vector<CrossingPlace>> crossing_places(const Yarns& yarns) {
    WEAVE_TRY(const double per_key, points_per_key(yarns));
    std::vector<Spline> planned;
    for (const SimulatedYarn& yarn : yarns.yarns)
        planned.push_back({yarn.planned, yarn.spline.is_periodic, yarn.spline.shift});
    std::vector<CrossingPlace> places;
    places.reserve(yarns.crossings.size());
    for (std::size_t i = 0; i < yarns.crossings.size(); ++i) {
        const Crossing& crossing = yarns.crossings[i];
        const SimulatedYarn &weft = yarns.yarns[crossing.weft], &warp = yarns.yarns[crossing.warp];
        const double t = per_key * static_cast<double>(crossing.weft_key),
                     s = per_key * static_cast<double>(crossing.warp_key);
        if (!has_key(weft.spline, t))
            return bad_input("lies beyond the end of its weft", indexed("crossings", i));
        if (!has_key(warp.spline, s))
            return bad_input("lies beyond the end of its warp", indexed("crossings", i));
        CrossingPlace place;
        place.planned_weft = at(planned[crossing.weft], t);
        place.planned_warp = at(planned[crossing.warp], s);
        place.weft = at(weft.spline, t);
        place.warp = at(warp.spline, s);
        place.spot = find_crossing({weft.spline, per_key}, {warp.spline, per_key}, crossing.weft_key,
                                   crossing.warp_key);
        places.push_back(place);
    }
    return places;
}

Result<OrderSubject> order_subject(const Yarns& yarns) {
    WEAVE_TRY(const double per_key, points_per_key(yarns));
    OrderSubject subject;
    for (const SimulatedYarn& yarn : yarns.yarns) {
        subject.planned.push_back({yarn.planned, yarn.spline.is_periodic, yarn.spline.shift});
        subject.now.push_back(yarn.spline);
        subject.per_key.push_back(per_key);
    }
    for (std::size_t k = 0; k < 2; ++k) subject.period_mm[k] = yarns.is_periodic[k] ? yarns.size_mm[k] : 0;
    return subject;
}

std::vector<std::size_t> sheets_of(const Yarns& yarns) {
    return SheetFinder(yarns).run();
}

std::vector<Strand> strands_of(const Yarns& yarns, const std::vector<CrossingPlace>& places,
                               const std::vector<char>& counted) {
    const std::vector<std::size_t> sheets = sheets_of(yarns);
    std::vector<Strand> strands;
    std::vector<std::size_t> order(yarns.crossings.size());
    for (const System system : {System::weft, System::warp}) {
        const bool warp = system == System::warp;
        const auto key = [&](std::size_t i) {
            const Crossing& c = yarns.crossings[i];
            return warp ? std::tuple(c.end, c.warp, c.warp_key, c.pick)
                        : std::tuple(c.pick, c.weft, c.weft_key, c.end);
        };
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, {}, key);
        for (const std::size_t i : order) {
            if (!counted.empty() && counted[i] == 0) continue;
            const auto [number, yarn, at, other] = key(i);
            if (strands.empty() || strands.back().system != system || strands.back().number != number ||
                strands.back().yarn != yarn)
                strands.push_back({system, number, yarn, sheets[yarn], {}});
            Strand& strand = strands.back();
            strand.crossings.push_back(i);
            strand.planned += warp ? places[i].planned_warp : places[i].planned_weft;
            strand.moved += warp ? Vec3(places[i].warp - places[i].planned_warp)
                                 : Vec3(places[i].weft - places[i].planned_weft);
        }
    }
    for (Strand& strand : strands) {
        const auto count = static_cast<double>(strand.crossings.size());
        strand.planned /= count;
        strand.moved /= count;
    }
    return strands;
}

}  // namespace weave::sim
