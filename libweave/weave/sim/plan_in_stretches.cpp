#include <weave/sim/plan_in_stretches.hpp>

#include <weave/curve/wrapped.hpp>

#include <algorithm>

namespace weave::sim {

Vec3 PlanInStretches::point(std::size_t yarn, std::size_t index) const {
    const auto at = static_cast<std::ptrdiff_t>(index);
    return m_points->control(m_plan.curve_of[yarn], at, at + 1).front();
}

Stretch PlanInStretches::stretch(std::size_t yarn, std::size_t first) const {
    const std::size_t curve = m_plan.curve_of[yarn], count = points(yarn);
    const auto whole = static_cast<std::ptrdiff_t>(count), own = static_cast<std::ptrdiff_t>(first), last = std::min(own + static_cast<std::ptrdiff_t>(m_points->most_at_once()), whole);
    std::ptrdiff_t begin = own - others, end = last + others;
    if (!m_plan.scene.yarns[yarn].is_periodic) {
        begin = std::max<std::ptrdiff_t>(begin, 0);
        end = std::min(end, whole);
    }
    Stretch stretch{yarn, first, static_cast<std::size_t>(last), begin, {}, {}};
    const std::vector<Vec3> control = m_points->control(curve, own, last);
    for (std::ptrdiff_t i = begin; i < end; ++i) {
        const std::ptrdiff_t index = wrapped(i, whole).index;
        stretch.control.push_back(index >= own && index < last ? control[static_cast<std::size_t>(index - own)] : m_points->control(curve, index, index + 1).front());
    }
    stretch.frozen = m_points->frozen(curve, begin, end);
    return stretch;
}

void PlanInStretches::each_stretch(const std::function<void(const Stretch&)>& visit) const {
    for (std::size_t yarn = 0; yarn < m_plan.curve_of.size(); ++yarn) {
        for (std::size_t first = 0; first < points(yarn); first += m_points->most_at_once()) visit(stretch(yarn, first));
    }
}

void PlanInStretches::each_crossing(const std::function<void(const Crossing&)>& visit) const {
    std::vector<std::size_t> yarn_of(m_plan.curves.yarns.size(), none);
    for (std::size_t y = 0; y < m_plan.curve_of.size(); ++y) yarn_of[m_plan.curve_of[y]] = y;
    for (std::size_t curve = 0; curve < m_plan.curves.yarns.size(); ++curve) {
        if (m_plan.curves.yarns[curve].system != System::weft) continue;
        m_layout->each_crossing(curve, [&](Crossing crossing) {
            crossing.weft = yarn_of[crossing.weft];
            crossing.warp = yarn_of[crossing.warp];
            visit(crossing);
        });
    }
}

}  // namespace weave::sim
