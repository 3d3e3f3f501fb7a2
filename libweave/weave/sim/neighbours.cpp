#include <weave/sim/neighbours.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

namespace weave::sim {

namespace {

/// Skin as a share of the smallest reach: wide enough that a list lasts for tens of steps near rest.
constexpr double skin_share = 0.25;
/// How much farther the wide list reaches, from which lists are made anew: it lasts while samples have gone
/// half of it.
constexpr double travel_share = 0.5;
/// Radii within this factor share a grid: a cell is then never more than twice too wide.
constexpr double class_ratio = 1.5;

using Cell = std::array<std::int32_t, 3>;

std::uint64_t key_of(const Cell& cell) {
    constexpr std::uint64_t mask = (std::uint64_t{1} << 21) - 1;
    return (static_cast<std::uint64_t>(cell[0]) & mask) << 42 |
           (static_cast<std::uint64_t>(cell[1]) & mask) << 21 | (static_cast<std::uint64_t>(cell[2]) & mask);
}

std::uint64_t mixed(std::uint64_t key) {
    key ^= key >> 31;
    key *= 0x9e3779b97f4a7c15ULL;
    key ^= key >> 29;
    return key;
}

}  // namespace

/// The samples of one class of radii, sorted by cell: cells are hashed, so empty space costs nothing.
template <class Real>
struct Neighbours<Real>::Grid {
    double radius = 0, width = 1;
    std::size_t mask = 0;
    std::vector<std::uint32_t> first;  ///< per bucket, and one more
    std::vector<std::uint32_t> samples;
    std::vector<std::uint64_t> keys;   ///< cell of each entry: buckets may be shared
    std::vector<Real> x, y, z, radii;  ///< of each entry

    [[nodiscard]] std::int32_t cell(double at) const {
        return static_cast<std::int32_t>(std::clamp(std::floor(at / width), -1e9, 1e9));
    }

    /// found(entry) for each entry of a cell.
    template <class Found>
    void visit(const Cell& at, const Found& found) const {
        const std::uint64_t key = key_of(at);
        const std::size_t bucket = mixed(key) & mask;
        for (std::uint32_t e = first[bucket]; e < first[bucket + 1]; ++e) {
            if (keys[e] == key) found(e);
        }
    }

    void fill(const std::vector<std::uint32_t>& members, const Neighbours& of) {
        const std::size_t buckets = std::bit_ceil(std::max<std::size_t>(16, members.size()));
        mask = buckets - 1;
        first.assign(buckets + 1, 0);
        std::vector<std::uint64_t> key(members.size());
        for (std::size_t i = 0; i < members.size(); ++i) {
            const std::uint32_t s = members[i];
            key[i] = key_of({cell(of.m_x[s]), cell(of.m_y[s]), cell(of.m_z[s])});
            ++first[(mixed(key[i]) & mask) + 1];
        }
        for (std::size_t b = 0; b < buckets; ++b) first[b + 1] += first[b];
        samples.resize(members.size());
        keys.resize(members.size());
        for (std::vector<Real>* array : {&x, &y, &z, &radii}) array->resize(members.size());
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        for (std::size_t i = 0; i < members.size(); ++i) {
            const std::uint32_t at = next[mixed(key[i]) & mask]++;
            const std::uint32_t sample = members[i];
            samples[at] = sample;
            keys[at] = key[i];
            x[at] = of.m_x[sample];
            y[at] = of.m_y[sample];
            z[at] = of.m_z[sample];
            radii[at] = of.m_radius[sample];
        }
    }
};

template <class Real>
Neighbours<Real>::Neighbours(const Fabric<Real>& fabric, const Executor& executor,
                             const Transition<Real>& transition)
    : m_fabric(fabric),
      m_executor(executor),
      m_transition(transition),
      m_own(fabric.samples()),
      m_skin(skin_share * fabric.least_reach()),
      m_wide_skin(m_skin + travel_share * fabric.least_reach()),
      m_x(m_own),
      m_y(m_own),
      m_z(m_own),
      m_weight(m_own),
      m_radius(m_own),
      m_segment_of(m_own) {
    std::vector<double> radii;
    for (const SimYarn& yarn : fabric.scene().yarns) radii.push_back(yarn.radius_mm);
    std::sort(radii.begin(), radii.end());
    for (const double radius : radii) {
        if (m_classes.empty() || radius > m_classes.back()) m_classes.push_back(radius * class_ratio);
    }
    // The bound of a class is the greatest radius in it.
    std::vector<double> greatest(m_classes.size(), 0);
    for (const SimYarn& yarn : fabric.scene().yarns) {
        const auto found = std::lower_bound(m_classes.begin(), m_classes.end(), yarn.radius_mm);
        const auto at = static_cast<std::size_t>(found - m_classes.begin());
        m_class_of_yarn.push_back(static_cast<std::uint32_t>(at));
        greatest[at] = std::max(greatest[at], yarn.radius_mm);
    }
    m_classes = greatest;
    for (std::size_t s = 0; s < fabric.segments(); ++s) {
        const SegmentPlace& segment = fabric.segment_places()[s];
        const YarnConstants<Real>& yarn = fabric.constants()[segment.yarn];
        for (std::uint32_t k = 0; k < yarn.samples; ++k) {
            m_segment_of[segment.sample + k] = static_cast<std::uint32_t>(s);
            m_radius[segment.sample + k] = yarn.radius_mm;
        }
    }
}

/// The farthest that a sample has gone since, squared.
template <class Real>
double Neighbours<Real>::gone_since(const std::vector<Real>& places) const {
    return m_executor.greatest(m_own, [&](std::size_t s) {
        const double dx = m_x[s] - places[3 * s], dy = m_y[s] - places[3 * s + 1],
                     dz = m_z[s] - places[3 * s + 2];
        return dx * dx + dy * dy + dz * dz;
    });
}

template <class Real>
bool Neighbours<Real>::holds() const {
    return m_builds > 0 && gone_since(m_built) <= m_skin * m_skin / 4;
}

template <class Real>
void Neighbours<Real>::update() {
    if (holds()) {
        move_halo();
    } else {
        build();
    }
}

template <class Real>
void Neighbours<Real>::move_halo() {
    const std::array<double, 2>& period = m_fabric.scene().period_mm;
    m_executor.each(m_halo.size(), [&](std::size_t h) {
        const HaloSample& halo = m_halo[h];
        m_x[m_own + h] = m_x[halo.of] + static_cast<Real>(halo.image[0] * period[0]);
        m_y[m_own + h] = m_y[halo.of] + static_cast<Real>(halo.image[1] * period[1]);
        m_z[m_own + h] = m_z[halo.of];
        m_weight[m_own + h] = m_weight[halo.of];
    });
}

template <class Real>
void Neighbours<Real>::keep_first_weights() {
    m_first_weight.assign(m_weight.begin(), m_weight.begin() + static_cast<std::ptrdiff_t>(m_own));
}

template <class Real>
void Neighbours<Real>::build() {
    if (m_first_weight.empty()) keep_first_weights();
    const double travel = m_wide_skin - m_skin;
    if (m_builds == 0 || gone_since(m_wide_built) > travel * travel / 4) {
        build_wide();
    } else {
        move_halo();
    }
    list_neighbours();
    keep_places(m_built);
    ++m_builds;
}

template <class Real>
void Neighbours<Real>::build_wide() {
    find_halo();
    std::vector<Grid> grids(m_classes.size());
    std::vector<std::vector<std::uint32_t>> members(m_classes.size());
    for (std::uint32_t s = 0; s < m_own + m_halo.size(); ++s)
        members[m_class_of_yarn[m_fabric.segment_places()[m_segment_of[own(s)]].yarn]].push_back(s);
    for (std::size_t c = 0; c < grids.size(); ++c) {
        grids[c].radius = m_classes[c];
        grids[c].width = std::max(1e-9, 2 * m_classes[c] + m_wide_skin);
        grids[c].fill(members[c], *this);
    }
    list_candidates(grids);
    keep_places(m_wide_built);
}

template <class Real>
void Neighbours<Real>::keep_places(std::vector<Real>& places) const {
    places.resize(3 * m_own);
    for (std::size_t s = 0; s < m_own; ++s) {
        places[3 * s] = m_x[s];
        places[3 * s + 1] = m_y[s];
        places[3 * s + 2] = m_z[s];
    }
}

/// Images of samples that come within reach of the box that holds all own samples.
template <class Real>
void Neighbours<Real>::find_halo() {
    m_halo.clear();
    const SimScene& scene = m_fabric.scene();
    const double reach = 2 * m_fabric.greatest_radius() + m_wide_skin;
    const std::array<const std::vector<Real>*, 2> axis{&m_x, &m_y};
    std::array<double, 2> low{}, high{};
    for (std::size_t k = 0; k < 2 && m_own > 0; ++k) {
        const auto [least, most] =
            std::minmax_element(axis[k]->begin(), axis[k]->begin() + static_cast<std::ptrdiff_t>(m_own));
        low[k] = *least - reach;
        high[k] = *most + reach;
    }
    // Images i of a sample at c with low <= c + i·period <= high.
    const auto images = [&](std::size_t k, double at) -> std::array<int, 2> {
        if (!scene.is_periodic[k] || !(scene.period_mm[k] > 0)) return {0, 0};
        return {static_cast<int>(std::ceil((low[k] - at) / scene.period_mm[k])),
                static_cast<int>(std::floor((high[k] - at) / scene.period_mm[k]))};
    };
    for (std::uint32_t s = 0; s < m_own; ++s) {
        const std::array<int, 2> along_x = images(0, m_x[s]), along_y = images(1, m_y[s]);
        for (int i = along_x[0]; i <= along_x[1]; ++i) {
            for (int j = along_y[0]; j <= along_y[1]; ++j) {
                if (i != 0 || j != 0)
                    m_halo.push_back({s, {static_cast<std::int16_t>(i), static_cast<std::int16_t>(j)}});
            }
        }
    }
    const std::size_t all = m_own + m_halo.size();
    for (std::vector<Real>* array : {&m_x, &m_y, &m_z, &m_weight, &m_radius}) array->resize(all);
    for (std::size_t h = 0; h < m_halo.size(); ++h) m_radius[m_own + h] = m_radius[m_halo[h].of];
    move_halo();
}

/// Whether another sample lies on the same stretch of the same yarn: within half a turn along it. Lengths are
/// those of the first list: were they of now, the energy would jump whenever a list is made anew.
template <class Real>
bool Neighbours<Real>::same_stretch(std::size_t sample, std::uint32_t other) const {
    const std::uint32_t of = own(other);
    const SegmentPlace &mine = m_fabric.segment_places()[m_segment_of[sample]],
                       &theirs = m_fabric.segment_places()[m_segment_of[of]];
    if (mine.yarn != theirs.yarn) return false;
    const SimYarn& yarn = m_fabric.scene().yarns[mine.yarn];
    const YarnPlace& place = m_fabric.yarns()[mine.yarn];
    const YarnConstants<Real>& constants = m_fabric.constants()[mine.yarn];
    if (!(constants.root_k > 0))
        return true;  // it does not feel itself, and lengths cannot be told from weights
    std::int64_t apart = static_cast<std::int64_t>(of) - static_cast<std::int64_t>(sample);
    if (other >= m_own) {
        const HaloSample& halo = m_halo[other - m_own];
        if (!yarn.is_periodic) return false;
        // The image lies on this very strand only where it is whole turns along it.
        std::int64_t turns = 0;
        for (std::size_t k = 0; k < 2; ++k) {
            if (yarn.turns[k] != 0) turns = halo.image[k] / yarn.turns[k];
        }
        for (std::size_t k = 0; k < 2; ++k) {
            if (halo.image[k] != turns * yarn.turns[k]) return false;
        }
        apart += turns * static_cast<std::int64_t>(place.segments) * constants.samples;
    }
    const double step =
        (m_first_weight[sample] + m_first_weight[of]) / (2 * static_cast<double>(constants.root_k));
    return std::abs(static_cast<double>(apart)) * step <
           std::numbers::pi * static_cast<double>(constants.radius_mm);
}

/// Samples that may be near those of one segment, and where they are: what a thread needs while it lists.
template <class Real>
struct Neighbours<Real>::Candidates {
    std::size_t count = 0;  ///< the arrays may be longer
    std::vector<std::uint32_t> samples;
    std::vector<Real> x, y, z, radius;

    void make_room(std::size_t more) {
        if (count + more <= samples.size()) return;
        const std::size_t size = 2 * (count + more);
        samples.resize(size);
        x.resize(size), y.resize(size), z.resize(size), radius.resize(size);
    }
    /// Writes down a sample, which is overwritten by the next if it is not kept: no branch that could be guessed wrong.
    void add(std::uint32_t sample, Real at_x, Real at_y, Real at_z, Real of_radius, bool is_kept) {
        samples[count] = sample;
        x[count] = at_x;
        y[count] = at_y;
        z[count] = at_z;
        radius[count] = of_radius;
        count += is_kept ? 1 : 0;
    }
};

/// The box around the samples of one segment.
template <class Real>
struct Neighbours<Real>::Box {
    std::array<double, 3> low{}, high{};

    /// All six are asked: no branch that could be guessed wrong.
    [[nodiscard]] bool holds(double x, double y, double z, double reach) const {
        const int inside = int(x >= low[0] - reach) & int(x <= high[0] + reach) & int(y >= low[1] - reach) &
                           int(y <= high[1] + reach) & int(z >= low[2] - reach) & int(z <= high[2] + reach);
        return inside != 0;
    }
};

template <class Real>
typename Neighbours<Real>::Box Neighbours<Real>::box_of(std::size_t segment) const {
    const SegmentPlace& place = m_fabric.segment_places()[segment];
    const std::size_t begin = place.sample, end = begin + m_fabric.constants()[place.yarn].samples;
    Box box;
    const std::array<const std::vector<Real>*, 3> axis{&m_x, &m_y, &m_z};
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [least, most] = std::minmax_element(axis[k]->begin() + static_cast<std::ptrdiff_t>(begin),
                                                       axis[k]->begin() + static_cast<std::ptrdiff_t>(end));
        box.low[k] = static_cast<double>(*least);
        box.high[k] = static_cast<double>(*most);
    }
    return box;
}

/// The samples of a segment lie close together, so cells are looked up once for all of them.
template <class Real>
void Neighbours<Real>::find_candidates(const std::vector<Grid>& grids, std::size_t segment,
                                       std::vector<std::uint32_t>& found) const {
    const Box box = box_of(segment);
    const auto radius = static_cast<double>(m_radius[m_fabric.segment_places()[segment].sample]);
    for (const Grid& grid : grids) {
        const double reach = radius + grid.radius + m_wide_skin;
        const auto add = [&](std::size_t at) {
            if (box.holds(grid.x[at], grid.y[at], grid.z[at], reach)) found.push_back(grid.samples[at]);
        };
        const Cell first{grid.cell(box.low[0] - reach), grid.cell(box.low[1] - reach),
                         grid.cell(box.low[2] - reach)},
            last{grid.cell(box.high[0] + reach), grid.cell(box.high[1] + reach),
                 grid.cell(box.high[2] + reach)};
        // A thick yarn spans more cells of thin ones than there are thin samples: then each of these is
        // looked at.
        const double cells =
            double(last[0] - first[0] + 1) * double(last[1] - first[1] + 1) * double(last[2] - first[2] + 1);
        if (cells > static_cast<double>(grid.samples.size())) {
            for (std::size_t at = 0; at < grid.samples.size(); ++at) add(at);
            continue;
        }
        for (std::int32_t i = first[0]; i <= last[0]; ++i) {
            for (std::int32_t j = first[1]; j <= last[1]; ++j) {
                for (std::int32_t k = first[2]; k <= last[2]; ++k) grid.visit({i, j, k}, add);
            }
        }
    }
}

/// Fills lists that follow one another, of `counts` entries, part by part: fill(part, list) appends those of
/// its part, which begin with list number first_of(part).
template <class Real>
template <class Fill, class FirstOf>
void Neighbours<Real>::join(std::size_t parts, std::vector<std::uint32_t>& first,
                            std::vector<std::uint32_t>& all, const Fill& fill,
                            const FirstOf& first_of) const {
    std::vector<std::vector<std::uint32_t>> lists(parts);
    m_executor.each(parts, [&](std::size_t part) { fill(part, lists[part]); });
    for (std::size_t i = 0; i + 1 < first.size(); ++i) first[i + 1] += first[i];
    all.resize(first.back());
    m_executor.each(parts, [&](std::size_t part) {
        std::ranges::copy(lists[part], all.begin() + first[first_of(part)]);
    });
}

/// The wide list: for each segment what may come near it before samples have gone far.
template <class Real>
void Neighbours<Real>::list_candidates(const std::vector<Grid>& grids) {
    const std::size_t segments = m_fabric.segments();
    m_first_candidate.assign(segments + 1, 0);
    join((segments + at_once - 1) / at_once, m_first_candidate, m_candidates,
         [&](std::size_t part, std::vector<std::uint32_t>& list) {
             for (std::size_t s = part * at_once; s < std::min(segments, (part + 1) * at_once); ++s) {
                 const std::size_t before = list.size();
                 find_candidates(grids, s, list);
                 m_first_candidate[s + 1] = static_cast<std::uint32_t>(list.size() - before);
             }
         },
         [&](std::size_t part) { return part * at_once; });
}

template <class Real>
void Neighbours<Real>::gather_candidates(std::size_t segment, Candidates& near) const {
    const std::uint32_t begin = m_first_candidate[segment], end = m_first_candidate[segment + 1];
    near.count = 0;
    near.make_room(end - begin + 1);
    const Box box = box_of(segment);
    const double reach = static_cast<double>(m_radius[m_fabric.segment_places()[segment].sample]) + m_skin;
    for (std::uint32_t e = begin; e < end; ++e) {
        const std::uint32_t b = m_candidates[e];
        near.add(b, m_x[b], m_y[b], m_z[b], m_radius[b],
                 box.holds(m_x[b], m_y[b], m_z[b], reach + static_cast<double>(m_radius[b])));
    }
}

template <class Real>
void Neighbours<Real>::list_neighbours() {
    const std::vector<SegmentPlace>& segments = m_fabric.segment_places();
    m_first.assign(m_own + 1, 0);
    join((segments.size() + at_once - 1) / at_once, m_first, m_others,
         [&](std::size_t part, std::vector<std::uint32_t>& list) {
             Candidates near;
             for (std::size_t s = part * at_once; s < std::min(segments.size(), (part + 1) * at_once); ++s) {
                 gather_candidates(s, near);
                 const std::uint32_t samples = m_fabric.constants()[segments[s].yarn].samples;
                 for (std::uint32_t a = segments[s].sample; a < segments[s].sample + samples; ++a) {
                     const std::size_t before = list.size();
                     list_near(a, near, list);
                     m_first[a + 1] = static_cast<std::uint32_t>(list.size() - before);
                 }
             }
         },
         [&](std::size_t part) { return segments[part * at_once].sample; });
}

namespace {

/// Numbers of the places that lie nearer to a point than `reach` and their own radius; how many. `found` has room for one
/// more than all.
template <class Real>
WEAVE_WIDE std::size_t take_near(std::size_t count, const Real* x, const Real* y, const Real* z, const Real* radius,
                                 const std::array<Real, 3>& at, double reach, std::uint32_t* found) {
    std::size_t taken = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double dx = x[i] - at[0], dy = y[i] - at[1], dz = z[i] - at[2], limit = reach + static_cast<double>(radius[i]);
        found[taken] = static_cast<std::uint32_t>(i);
        taken += dx * dx + dy * dy + dz * dz < limit * limit ? 1 : 0;
    }
    return taken;
}

}  // namespace

template <class Real>
void Neighbours<Real>::list_near(std::uint32_t sample, const Candidates& candidates,
                                 std::vector<std::uint32_t>& list) const {
    const std::size_t before = list.size(), count = candidates.count;
    list.resize(before + count + 1);
    const std::size_t found = take_near(count, candidates.x.data(), candidates.y.data(), candidates.z.data(),
                                        candidates.radius.data(), std::array{m_x[sample], m_y[sample], m_z[sample]},
                                        static_cast<double>(m_radius[sample]) + m_skin, &list[before]);
    std::size_t kept = before;
    for (std::size_t i = before; i < before + found; ++i) {
        const std::uint32_t b = candidates.samples[list[i]];
        const bool counts = m_fabric.is_felt(m_segment_of[sample]) || m_fabric.is_felt(m_segment_of[own(b)]);
        if (counts && b != sample && !same_stretch(sample, b) && !m_transition.parts(sample, own(b))) list[kept++] = b;
    }
    list.resize(kept);
    // Images among their own samples, so that those of one segment follow one another.
    std::sort(list.begin() + static_cast<std::ptrdiff_t>(before), list.end(), [&](std::uint32_t p, std::uint32_t q) {
        return std::pair(own(p), p) < std::pair(own(q), q);
    });
}

template <class Real>
std::size_t Neighbours<Real>::bytes() const {
    return (m_x.capacity() * 5 + m_built.capacity() + m_wide_built.capacity() + m_first_weight.capacity()) *
               sizeof(Real) +
           (m_segment_of.capacity() + m_first.capacity() + m_others.capacity() +
            m_first_candidate.capacity() + m_candidates.capacity()) *
               4 +
           m_halo.capacity() * sizeof(HaloSample);
}

template class Neighbours<float>;
template class Neighbours<double>;

}  // namespace weave::sim
