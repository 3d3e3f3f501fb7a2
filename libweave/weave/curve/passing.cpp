// How yarns of one system get past one another in their line.
//
// All yarns of a line run through it at the same rate, so two meet only where at one and the same parameter
// they have one height and one sideways place: a question about one cubic, their difference.
//
// Heights that a spline gives can cross as near to a stack as they like, where no yarn is aside yet, and then
// no way aside is wide enough. So the last resort is another height, with which that cannot be: level in the
// stacks, and from one to the next half a cosine, while the yarns go aside by half a sine. Heights of two then
// cross only where the two change places, and they go round one another on half an ellipse: at levels d and D
// apart in the stacks, when they are equally high they are 2 sqrt(dD)/(d + D) of their full distance aside.

#include <weave/curve/passing.hpp>

#include <weave/curve/nearness.hpp>
#include <weave/curve/spline.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace weave {

namespace {

constexpr double near_levels = 0.25;  ///< yarns that come nearer than this in height are led aside
constexpr double share_kept = 0.1;    ///< of their sideways difference, that two have to keep everywhere
constexpr std::size_t most_keys = 8;

/// Two yarns that come near from stack `segment` of the line to the next.
struct Pass {
    std::size_t yarn = 0, other = 0, segment = 0;
};

CubicPiece difference(const CubicPiece& a, const CubicPiece& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]};
}

class Line {
  public:
    Line(const std::vector<LineYarn>& yarns, const LineSpacing& spacing, LineWay way = {})
        : m_yarns(yarns), m_spacing(spacing), m_way(std::move(way)) {
        for (const LineYarn& yarn : yarns) m_heights.push_back(heights(yarn));
    }

    LineWay find_way(std::size_t effort) && {
        find_passes();
        set_aside();
        m_way.keys = enough_keys(effort);
        return std::move(m_way);
    }

    std::vector<Lead> leads() const { return all_leads(m_way.keys); }

  private:
    /// Key points from stack to stack that keep all apart, led as far aside as it takes.
    std::size_t enough_keys(std::size_t effort) {
        if (m_passes.empty() && effort < most_effort) return 1;
        for (std::size_t keys = 2; keys <= most_keys; keys *= 2) {
            for (const bool wider : {false, true}) {
                if (wider) widen();
                if (effort > 0) {
                    --effort;
                    continue;
                }
                if (keep_apart(all_leads(keys))) return keys;
            }
        }
        m_way.is_level_in_stacks = true;
        return most_keys;
    }

    Spline heights(const LineYarn& yarn) const {
        std::vector<Vec3> keys;
        for (std::size_t k = 0; k < yarn.levels.size(); ++k) {
            keys.emplace_back(static_cast<double>(k) * m_spacing.along_mm, 0,
                              yarn.levels[k] * m_spacing.level_mm);
        }
        return interpolate(keys, m_spacing.is_periodic, repeat(yarn));
    }

    Vec3 repeat(const LineYarn& yarn) const {
        return {static_cast<double>(yarn.levels.size()) * m_spacing.along_mm, 0, 0};
    }

    void find_passes() {
        std::vector<std::vector<CubicPiece>> pieces(m_yarns.size());
        for (std::size_t a = 0; a < m_yarns.size(); ++a) {
            m_way.led.emplace_back(m_heights[a].segments(), false);
            for (std::size_t s = 0; s < m_heights[a].segments(); ++s)
                pieces[a].push_back(bezier(m_heights[a], s));
            for (std::size_t b = 0; b < a; ++b) find_passes(a, b, pieces[a], pieces[b]);
        }
    }

    void find_passes(std::size_t a, std::size_t b, const std::vector<CubicPiece>& on_a,
                     const std::vector<CubicPiece>& on_b) {
        const std::size_t first_a = m_yarns[a].first, first_b = m_yarns[b].first,
                          end = std::min(first_a + on_a.size(), first_b + on_b.size());
        for (std::size_t s = std::max(first_a, first_b); s < end; ++s) {
            CubicPiece apart = difference(on_a[s - first_a], on_b[s - first_b]);
            for (Vec3& point : apart) point.y() = 0;
            if (stays_off_axis(apart, near_levels * m_spacing.level_mm)) continue;
            m_passes.push_back({a, b, s});
            m_way.led[a][s - first_a] = m_way.led[b][s - first_b] = true;
        }
    }

    /// Every yarn that is led aside anywhere gets its own distance from the line.
    void set_aside() {
        m_way.aside_mm.assign(m_yarns.size(), 0);
        std::vector<std::size_t> led;
        for (std::size_t a = 0; a < m_yarns.size(); ++a) {
            if (std::ranges::find(m_way.led[a], true) != m_way.led[a].end()) led.push_back(a);
        }
        if (led.size() < 2) return;
        const double gaps = static_cast<double>(led.size()) - 1,
                     step = std::min(m_spacing.wish_aside_mm, 2 * m_spacing.most_aside_mm / gaps);
        for (std::size_t k = 0; k < led.size(); ++k)
            m_way.aside_mm[led[k]] = (static_cast<double>(k) - gaps / 2) * step;
    }

    /// Leads every yarn aside one segment further both ways.
    void widen() {
        for (std::vector<bool>& led : m_way.led) {
            const std::vector<bool> before = led;
            const std::size_t n = led.size();
            for (std::size_t s = 0; s < n; ++s) {
                if (!before[s]) continue;
                if (s + 1 < n || m_spacing.is_periodic) led[(s + 1) % n] = true;
                if (s > 0 || m_spacing.is_periodic) led[(s + n - 1) % n] = true;
            }
        }
    }

    std::vector<Lead> all_leads(std::size_t keys) const {
        std::vector<Lead> leads;
        for (std::size_t a = 0; a < m_yarns.size(); ++a) {
            const bool goes_plainly = m_way.aside_mm[a] == 0 && !m_way.is_level_in_stacks;
            leads.push_back(lead(a, goes_plainly ? 1 : keys));
        }
        return leads;
    }

    Lead lead(std::size_t yarn, std::size_t keys) const {
        Lead lead{keys, {}, {}};
        const std::size_t segments = m_heights[yarn].segments();
        for (std::size_t k = 0; k < segments * keys + (m_spacing.is_periodic ? 0 : 1); ++k) {
            const std::size_t s = k / keys, part = k % keys;
            const double way = static_cast<double>(part) / static_cast<double>(keys);
            lead.level.push_back(part == 0 ? m_yarns[yarn].levels[s] : level_between(yarn, s, way));
            const bool aside = part != 0 && m_way.led[yarn][s];
            lead.aside_mm.push_back(aside ? m_way.aside_mm[yarn] * std::sin(std::numbers::pi * way) : 0);
        }
        return lead;
    }

    /// The level at which a yarn runs at `way`, 0 to 1, from stack `s` of its line to the next.
    double level_between(std::size_t yarn, std::size_t s, double way) const {
        if (!m_way.is_level_in_stacks)
            return m_heights[yarn].place(static_cast<double>(s) + way).z() / m_spacing.level_mm;
        const std::vector<double>& levels = m_yarns[yarn].levels;
        const double from = levels[s], to = levels[(s + 1) % levels.size()];
        return from + (to - from) * (1 - std::cos(std::numbers::pi * way)) / 2;
    }

    Spline curve(std::size_t yarn, const Lead& lead) const {
        std::vector<Vec3> keys;
        for (std::size_t k = 0; k < lead.level.size(); ++k) {
            keys.emplace_back(static_cast<double>(k) * m_spacing.along_mm / static_cast<double>(lead.keys),
                              lead.aside_mm[k], lead.level[k] * m_spacing.level_mm);
        }
        return interpolate(keys, m_spacing.is_periodic, repeat(m_yarns[yarn]));
    }

    /// Whether all that pass one another keep their distance where they do. One that is not led aside passes
    /// in the middle, with key points of its own as many as the other's.
    bool keep_apart(const std::vector<Lead>& leads) const {
        const std::size_t keys =
            std::max_element(leads.begin(), leads.end(), [](const Lead& a, const Lead& b) {
                return a.keys < b.keys;
            })->keys;
        std::vector<Spline> curves;
        for (std::size_t a = 0; a < leads.size(); ++a) {
            curves.push_back(curve(a, leads[a].keys == keys ? leads[a] : lead(a, keys)));
        }
        return std::all_of(m_passes.begin(), m_passes.end(), [&](const Pass& pass) {
            const double least = share_kept * std::abs(m_way.aside_mm[pass.yarn] - m_way.aside_mm[pass.other]);
            for (std::size_t part = 0; part < keys; ++part) {
                const auto piece = [&](std::size_t yarn) {
                    return bezier(curves[yarn], (pass.segment - m_yarns[yarn].first) * keys + part);
                };
                if (!stays_off_axis(difference(piece(pass.yarn), piece(pass.other)), least)) return false;
            }
            return true;
        });
    }

    const std::vector<LineYarn>& m_yarns;
    const LineSpacing& m_spacing;
    std::vector<Spline> m_heights;
    std::vector<Pass> m_passes;
    LineWay m_way;
};

}  // namespace

LineWay find_way(const std::vector<LineYarn>& yarns, const LineSpacing& spacing, std::size_t effort) {
    return Line(yarns, spacing).find_way(effort);
}

std::vector<Lead> leads_along(const std::vector<LineYarn>& yarns, const LineSpacing& spacing, const LineWay& way) {
    return Line(yarns, spacing, way).leads();
}

}  // namespace weave
