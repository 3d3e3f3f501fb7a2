#pragma once

// The bodies that lay contact samples and list which may touch (lists.hpp). Those that fill a list run twice: once to count what each
// has, once to write it where the counts, summed up, say.

#include <weave/sim/device/atomic.hpp>
#include <weave/sim/device/lists_view.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// Lays one own sample.
template <class Real>
struct LaySamples {
    ClothView<Real> cloth;
    View<const double> state;
    View<Sample<Real>> sample;

    WEAVE_HD void operator()(std::size_t index) const {
        const SegmentPlace segment = cloth.segment[cloth.segment_of_sample[index]];
        const YarnConstants<Real>& yarn = cloth.yarn[segment.yarn];
        const Basis<Real>& basis = cloth.basis[yarn.basis + (index - segment.sample)];
        Real slots[12];
        load_around_first(state, segment.slot, slots);
        const Vec<Real> at = combine(basis.value, slots);
        const double* first = state.at(3 * std::size_t(segment.slot), 3);
        Sample<Real> laid;
        for (int k = 0; k < 3; ++k)
            laid.at[k] = counted<Real>(first[k] + static_cast<double>(at[k]), cloth.scale.origin[k], cloth.scale.step_mm);
        laid.weight = yarn.root_k / Real(yarn.samples) * combine(basis.slope, slots).norm();
        sample[index] = laid;
    }
};

/// How far a sample has gone since, squared.
template <class Real>
struct GoneSince {
    View<Sample<Real>> sample, before;
    Real step_mm;

    WEAVE_HD double operator()(std::size_t index) const {
        return static_cast<double>(apart(sample[index], before[index], step_mm).squaredNorm());
    }
};

/// Where a sample lies along an axis, mm from the scale's origin, times `turn`.
template <class Real>
struct PlaceAlong {
    ClothView<Real> cloth;
    View<Sample<Real>> sample;
    int axis;
    double turn = 1;

    WEAVE_HD double operator()(std::size_t index) const { return turn * mm_along(cloth, sample[index], axis); }
};

/// The same of any sample. Double places have no scale.
template <class Real>
WEAVE_HD inline double mm_along(const ClothView<Real>& cloth, const Sample<Real>& sample, int axis) {
    if constexpr (std::is_same_v<Real, float>) return sample.at[axis] * cloth.scale.step_mm;
    else return static_cast<double>(sample.at[axis]);
}

/// Places an image of a sample.
template <class Real>
struct MoveImages {
    ClothView<Real> cloth;
    View<HaloSample> halo;
    View<Sample<Real>> sample;

    WEAVE_HD void operator()(std::size_t index) const {
        const HaloSample image = halo[index];
        Sample<Real> moved = sample[image.of];
        for (int k = 0; k < 2; ++k)
            moved.at[k] += counted<Real>(image.image[std::size_t(k)] * cloth.period_mm[k], 0, cloth.scale.step_mm);
        sample[cloth.samples + index] = moved;
    }
};

/// Lists the images of one sample that lie in a box; of the sample after the last it counts none.
template <class Real>
struct FindImages {
    ClothView<Real> cloth;
    View<Sample<Real>> sample;
    double low[2], high[2];  ///< mm from the scale's origin
    View<std::uint32_t> first;
    View<HaloSample> halo;
    View<Real> radius;
    bool fills;

    WEAVE_HD FindImages filling() const {
        FindImages same = *this;
        same.fills = true;
        return same;
    }

    WEAVE_HD void operator()(std::size_t index) const {
        if (index == cloth.samples) {
            first[index] = 0;
            return;
        }
        const Real of_yarn = cloth.yarn[cloth.segment[cloth.segment_of_sample[index]].yarn].radius_mm;
        int from[2]{0, 0}, to[2]{0, 0};
        for (int k = 0; k < 2; ++k) {
            if (!(cloth.period_mm[k] > 0)) continue;
            const double at = mm_along(cloth, sample[index], k);
            from[k] = static_cast<int>(ceil((low[k] - at) / cloth.period_mm[k]));
            to[k] = static_cast<int>(floor((high[k] - at) / cloth.period_mm[k]));
        }
        if (fills) radius[index] = of_yarn;
        std::uint32_t count = 0;
        for (int i = from[0]; i <= to[0]; ++i) {
            for (int j = from[1]; j <= to[1]; ++j) {
                if (i == 0 && j == 0) continue;
                if (fills) {
                    const std::size_t at = first[index] + count;
                    halo[at] = {static_cast<std::uint32_t>(index), {static_cast<std::int16_t>(i), static_cast<std::int16_t>(j)}};
                    radius[cloth.samples + at] = of_yarn;
                }
                ++count;
            }
        }
        if (!fills) first[index] = count;
    }
};

/// Samples by the cell that they lie in: a hashed grid for each class of radii, all in one table of buckets. After it was filled
/// `first[b]` tells where bucket b ends, and the next begins.
struct CellsView {
    View<std::uint32_t> first;   ///< per bucket, and one more
    View<std::uint32_t> sample;  ///< of each entry
    View<std::uint64_t> key;     ///< cell of each entry: buckets may be shared
    std::uint32_t mask = 0;      ///< buckets less one

    WEAVE_HD static std::uint64_t key_of(std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t radius_class) {
        constexpr std::uint64_t bits = (1ULL << 20) - 1;
        return std::uint64_t(radius_class) << 60 | (std::uint64_t(std::uint32_t(i)) & bits) << 40 |
               (std::uint64_t(std::uint32_t(j)) & bits) << 20 | (std::uint64_t(std::uint32_t(k)) & bits);
    }
    WEAVE_HD std::uint32_t bucket_of(std::uint64_t of) const {
        of ^= of >> 31;
        of *= 0x9e3779b97f4a7c15ULL;
        of ^= of >> 29;
        return static_cast<std::uint32_t>(of) & mask;
    }
    WEAVE_HD static std::int32_t cell(double at_mm, double width_mm) {
        const double cell = floor(at_mm / width_mm);
        return static_cast<std::int32_t>(cell < -1e9 ? -1e9 : cell > 1e9 ? 1e9 : cell);
    }
};

struct EmptyCells {
    CellsView cells;

    WEAVE_HD void operator()(std::size_t bucket) const { cells.first[bucket] = 0; }
};

/// Width of the cells of a class: two of its samples that may be near lie in cells that touch.
template <class Real>
WEAVE_HD inline double cell_width(const ClothView<Real>& cloth, std::uint32_t radius_class, double skin_mm) {
    const double width = 2 * cloth.class_radius_mm[radius_class] + skin_mm;
    return width > 1e-9 ? width : 1e-9;
}

template <class Real>
struct SortIntoCells {
    ClothView<Real> cloth;
    ListsView<Real> lists;
    CellsView cells;
    double skin_mm;
    bool fills;

    WEAVE_HD SortIntoCells filling() const {
        SortIntoCells same = *this;
        same.fills = true;
        return same;
    }

    WEAVE_HD void operator()(std::size_t index) const {
        const std::uint32_t own = lists.own_of(static_cast<std::uint32_t>(index));
        const std::uint32_t of_class = cloth.span[cloth.segment[cloth.segment_of_sample[own]].yarn].radius_class;
        const double width = cell_width(cloth, of_class, skin_mm);
        const Sample<Real> sample = lists.sample[index];
        const std::uint64_t key = CellsView::key_of(CellsView::cell(mm_along(cloth, sample, 0), width),
                                                    CellsView::cell(mm_along(cloth, sample, 1), width),
                                                    CellsView::cell(mm_along(cloth, sample, 2), width), of_class);
        const std::uint32_t at = count_up(cells.first[cells.bucket_of(key)]);
        if (!fills) return;
        cells.sample[at] = static_cast<std::uint32_t>(index);
        cells.key[at] = key;
    }
};

/// The box around the samples of a segment, mm from the scale's origin.
struct SegmentBox {
    double low[3]{1e300, 1e300, 1e300}, high[3]{-1e300, -1e300, -1e300};

    template <class Real>
    WEAVE_HD SegmentBox(const ClothView<Real>& cloth, const ListsView<Real>& lists, const SegmentPlace& segment) {
        for (std::uint32_t k = 0; k < cloth.yarn[segment.yarn].samples; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                const double at = mm_along(cloth, lists.sample[segment.sample + k], axis);
                low[axis] = at < low[axis] ? at : low[axis];
                high[axis] = at > high[axis] ? at : high[axis];
            }
        }
    }

    template <class Real>
    WEAVE_HD bool holds(const ClothView<Real>& cloth, const Sample<Real>& sample, double reach_mm) const {
        for (int axis = 0; axis < 3; ++axis) {
            const double at = mm_along(cloth, sample, axis);
            if (!(at >= low[axis] - reach_mm && at <= high[axis] + reach_mm)) return false;
        }
        return true;
    }
};

/// Lists the samples that may come near one segment; for the segment after the last it counts none.
template <class Real>
struct FindCandidates {
    ClothView<Real> cloth;
    ListsView<Real> lists;
    CellsView cells;
    double skin_mm;
    View<std::uint32_t> first, candidate;
    bool fills;

    WEAVE_HD FindCandidates filling() const {
        FindCandidates same = *this;
        same.fills = true;
        return same;
    }

    WEAVE_HD void operator()(std::size_t index) const {
        if (index == cloth.segments) {
            first[index] = 0;
            return;
        }
        const SegmentPlace& segment = cloth.segment[index];
        const SegmentBox box(cloth, lists, segment);
        std::uint32_t count = fills ? first[index] : 0;
        for (std::uint32_t c = 0; c < cloth.classes; ++c) look_at_class(segment, box, c, count);
        if (!fills) first[index] = count;
    }

  private:
    WEAVE_HD void look_at_class(const SegmentPlace& segment, const SegmentBox& box, std::uint32_t of_class, std::uint32_t& count) const {
        const double reach = static_cast<double>(cloth.yarn[segment.yarn].radius_mm) + cloth.class_radius_mm[of_class] + skin_mm,
                     width = cell_width(cloth, of_class, skin_mm);
        std::int32_t from[3], to[3];
        double number = 1;
        for (int axis = 0; axis < 3; ++axis) {
            from[axis] = CellsView::cell(box.low[axis] - reach, width);
            to[axis] = CellsView::cell(box.high[axis] + reach, width);
            number *= double(to[axis] - from[axis]) + 1;
        }
        // A thick yarn spans more cells of thin ones than there are samples: then each of these is looked at.
        const std::uint32_t all = cells.first[cells.mask];
        if (number > double(all)) return look_at(0, all, of_class, box, reach, count);
        for (std::int32_t i = from[0]; i <= to[0]; ++i) {
            for (std::int32_t j = from[1]; j <= to[1]; ++j) {
                for (std::int32_t k = from[2]; k <= to[2]; ++k) {
                    const std::uint64_t key = CellsView::key_of(i, j, k, of_class);
                    const std::uint32_t bucket = cells.bucket_of(key), begin = bucket == 0 ? 0 : cells.first[bucket - 1];
                    look_at(begin, cells.first[bucket], key, box, reach, count);
                }
            }
        }
    }

    WEAVE_HD void look_at(std::uint32_t begin, std::uint32_t end, std::uint64_t key, const SegmentBox& box, double reach, std::uint32_t& count) const {
        for (std::uint32_t e = begin; e < end; ++e) {
            if (cells.key[e] == key) keep(e, box, reach, count);
        }
    }
    WEAVE_HD void look_at(std::uint32_t begin, std::uint32_t end, std::uint32_t of_class, const SegmentBox& box, double reach,
                          std::uint32_t& count) const {
        for (std::uint32_t e = begin; e < end; ++e) {
            if (cells.key[e] >> 60 == of_class) keep(e, box, reach, count);
        }
    }
    WEAVE_HD void keep(std::uint32_t entry, const SegmentBox& box, double reach, std::uint32_t& count) const {
        if (!box.holds(cloth, lists.sample[cells.sample[entry]], reach)) return;
        if (fills) candidate[count] = cells.sample[entry];
        ++count;
    }
};

/// Brings the candidates of one segment into the order of (own sample, sample): images among their own samples, so that those
/// of one segment follow one another. In whichever order they were found, the lists are then the same.
template <class Real>
struct SortCandidates {
    ListsView<Real> lists;
    View<std::uint32_t> first, candidate;

    WEAVE_HD void operator()(std::size_t segment) const {
        const std::uint32_t begin = first[segment], count = first[segment + 1] - begin;
        const View<std::uint32_t> heap = candidate.slice(begin, count);
        for (std::uint32_t root = count / 2; root-- > 0;) sink(heap, root, count);
        for (std::uint32_t end = count; end-- > 1;) {
            const std::uint32_t last = heap[end];
            heap[end] = heap[0];
            heap[0] = last;
            sink(heap, 0, end);
        }
    }

  private:
    WEAVE_HD bool before(std::uint32_t a, std::uint32_t b) const {
        const std::uint32_t own_a = lists.own_of(a), own_b = lists.own_of(b);
        return own_a != own_b ? own_a < own_b : a < b;
    }
    WEAVE_HD void sink(const View<std::uint32_t>& heap, std::uint32_t root, std::uint32_t count) const {
        const std::uint32_t moved = heap[root];
        for (std::uint32_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
            if (child + 1 < count && before(heap[child], heap[child + 1])) ++child;
            if (!before(moved, heap[child])) break;
            heap[root] = heap[child];
            root = child;
        }
        heap[root] = moved;
    }
};

/// Lists the samples that may touch one own sample, in the order of its segment's candidates; of the sample after the last it
/// counts none.
template <class Real>
struct ListNeighbours {
    ClothView<Real> cloth;
    ListsView<Real> lists;
    double skin_mm;
    View<const Real> first_weight;
    View<std::uint32_t> first_candidate, candidate;
    bool fills;

    WEAVE_HD ListNeighbours filling() const {
        ListNeighbours same = *this;
        same.fills = true;
        return same;
    }

    WEAVE_HD void operator()(std::size_t index) const {
        if (index == cloth.samples) {
            lists.first[index] = 0;
            return;
        }
        const auto step = static_cast<Real>(cloth.scale.step_mm), reach = lists.radius[index] + static_cast<Real>(skin_mm);
        const Sample<Real> mine = lists.sample[index];
        const std::uint32_t segment = cloth.segment_of_sample[index];
        std::uint32_t count = fills ? lists.first[index] : 0;
        for (std::uint32_t e = first_candidate[segment]; e < first_candidate[segment + 1]; ++e) {
            const std::uint32_t b = candidate[e];
            const Real limit = reach + lists.radius[b];
            if (!(apart(mine, lists.sample[b], step).squaredNorm() < limit * limit) || b == index || same_stretch(index, b)) continue;
            if (fills) lists.neighbour[count] = b;
            ++count;
        }
        if (!fills) lists.first[index] = count;
    }

  private:
    /// Whether another sample lies on the same stretch of the same yarn: within half a turn along it, in lengths of the first list.
    WEAVE_HD bool same_stretch(std::size_t index, std::uint32_t other) const {
        const std::uint32_t of = lists.own_of(other), yarn = cloth.segment[cloth.segment_of_sample[index]].yarn;
        if (cloth.segment[cloth.segment_of_sample[of]].yarn != yarn) return false;
        const YarnConstants<Real>& constants = cloth.yarn[yarn];
        const YarnSpan& span = cloth.span[yarn];
        if (!(constants.root_k > 0)) return true;  // it does not feel itself, and lengths cannot be told from weights
        double along = double(of) - double(index);
        if (other >= cloth.samples) {
            const HaloSample image = lists.halo[other - cloth.samples];
            if (!span.is_periodic) return false;
            // The image lies on this very strand only where it is whole turns along it.
            int turns = 0;
            for (std::size_t k = 0; k < 2; ++k) {
                if (span.turns[k] != 0) turns = image.image[k] / span.turns[k];
            }
            for (std::size_t k = 0; k < 2; ++k) {
                if (image.image[k] != turns * span.turns[k]) return false;
            }
            along += double(turns) * span.segments * constants.samples;
        }
        const double step = (static_cast<double>(first_weight[index]) + static_cast<double>(first_weight[of])) /
                            (2 * static_cast<double>(constants.root_k));
        constexpr double pi = 3.14159265358979323846;
        return (along < 0 ? -along : along) * step < pi * static_cast<double>(constants.radius_mm);
    }
};

}  // namespace weave::sim
