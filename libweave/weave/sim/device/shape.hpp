#pragma once

// Which blocks the matrix of second derivatives has: those between control points of one segment, and of segments whose
// contact samples may touch.

#include <weave/sim/device/cloth_view.hpp>
#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/lists_view.hpp>
#include <weave/sim/device/matrix.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// The segments that may touch each segment, rising. Those of yarns of no higher number come first and are the *pairs* of a
/// segment: what two yarns share is made for the one of higher number.
struct NearView {
    View<std::uint32_t> first;       ///< per segment, and one more
    View<std::uint32_t> segment;
    View<std::uint32_t> first_pair;  ///< per segment, and one more
    View<std::uint32_t> owner;       ///< of each pair, the segment that has it
};

/// What is stored for the second derivatives, and so what arrays must have room for.
struct CurvatureNeeds {
    std::uint64_t near = 0;         ///< near segments
    std::uint64_t pairs = 0;
    std::uint64_t blocks = 0;       ///< of the matrix
    std::uint64_t slot_blocks = 0;  ///< 4 × 4 blocks of segments, of as many as are worked on at once
};

/// Where in a sample's list, from `begin` on, those begin that are, or are images of, own samples from `least` on.
template <class Real>
WEAVE_HD inline std::uint32_t first_neighbour_from(const ListsView<Real>& lists, std::uint32_t begin, std::uint32_t end, std::uint32_t least) {
    while (begin < end) {
        const std::uint32_t middle = begin + (end - begin) / 2;
        if (lists.own_of(lists.neighbour[middle]) < least) begin = middle + 1;
        else end = middle;
    }
    return begin;
}
template <class Real>
WEAVE_HD inline std::uint32_t first_neighbour_from(const ListsView<Real>& lists, std::uint32_t sample, std::uint32_t least) {
    return first_neighbour_from(lists, lists.first[sample], lists.first[sample + 1], least);
}

/// Some of the segments near to one, rising. So many at once that the lists of its samples, of which a thin yarn has hundreds in a
/// segment, are gone through once or a few times, and not anew for each near segment.
struct SomeNear {
    static constexpr std::uint32_t most = 32;
    std::uint32_t count = 0;
    std::uint32_t segment[most];

    [[nodiscard]] WEAVE_HD bool is_full() const { return count == most; }
    [[nodiscard]] WEAVE_HD std::uint32_t last() const { return segment[count - 1]; }

    /// Puts a segment where it belongs; of too many the last ones are left out.
    WEAVE_HD void insert(std::uint32_t of) {
        std::uint32_t at = 0, end = count;
        while (at < end) {
            const std::uint32_t middle = at + (end - at) / 2;
            if (segment[middle] < of) at = middle + 1;
            else end = middle;
        }
        if (at == most || (at < count && segment[at] == of)) return;
        if (!is_full()) ++count;
        for (std::uint32_t k = count - 1; k > at; --k) segment[k] = segment[k - 1];
        segment[at] = of;
    }
};

/// The segments near to one of them, from the lists of its samples.
template <class Real>
struct NearOfSegment {
    ClothView<Real> cloth;
    ListsView<Real> lists;

    /// emit(near segment) for each, rising.
    template <class Emit>
    WEAVE_HD void visit(std::uint32_t segment, Emit& emit) const {
        SomeNear some;
        for (std::uint32_t from = 0; from < cloth.segments; from = some.last() + 1) {
            find(segment, from, some);
            for (std::uint32_t k = 0; k < some.count; ++k) emit(some.segment[k]);
            if (!some.is_full()) return;
        }
    }

  private:
    /// The first near segments that are no less than `from`. Neighbours of a sample rise.
    WEAVE_HD void find(std::uint32_t segment, std::uint32_t from, SomeNear& some) const {
        some.count = 0;
        const SegmentPlace place = cloth.segment[segment];
        const std::uint32_t least = cloth.segment[from].sample, samples = cloth.yarn[place.yarn].samples;
        for (std::uint32_t a = place.sample; a < place.sample + samples; ++a) {
            const std::uint32_t end = lists.first[a + 1];
            for (std::uint32_t at = first_neighbour_from(lists, a, least); at < end;) {
                const std::uint32_t found = cloth.segment_of_sample[lists.own_of(lists.neighbour[at])];
                if (some.is_full() && found > some.last()) break;
                some.insert(found);
                const SegmentPlace of = cloth.segment[found];
                at = first_neighbour_from(lists, at + 1, end, of.sample + cloth.yarn[of.yarn].samples);
            }
        }
    }
};

template <class Real>
struct CountNear {
    NearOfSegment<Real> of;
    NearView near;

    struct Count {
        View<const SegmentPlace> segment;
        std::uint32_t yarn, count = 0, pairs = 0;
        WEAVE_HD void operator()(std::uint32_t other) {
            ++count;
            if (segment[other].yarn <= yarn) ++pairs;
        }
    };

    WEAVE_HD void operator()(std::size_t segment) const {
        Count count{of.cloth.segment, 0, 0, 0};
        if (segment < of.cloth.segments) {
            count.yarn = of.cloth.segment[segment].yarn;
            of.visit(static_cast<std::uint32_t>(segment), count);
        }
        near.first[segment] = count.count;
        near.first_pair[segment] = count.pairs;
    }
};

template <class Real>
struct FillNear {
    NearOfSegment<Real> of;
    NearView near;

    struct Fill {
        View<std::uint32_t> near;
        std::uint32_t at;
        WEAVE_HD void operator()(std::uint32_t other) { near[at++] = other; }
    };

    WEAVE_HD void operator()(std::size_t index) const {
        const auto segment = static_cast<std::uint32_t>(index);
        Fill fill{near.segment, near.first[segment]};
        of.visit(segment, fill);
        for (std::uint32_t p = near.first_pair[segment]; p < near.first_pair[segment + 1]; ++p) near.owner[p] = segment;
    }
};

/// The segments of one yarn that a slot bends: `first` to `last`, both among them.
struct SegmentsOfSlot {
    std::uint32_t first, last;

    WEAVE_HD SegmentsOfSlot(const YarnSpan& span, std::uint32_t slot) {
        const std::uint32_t at = slot - span.first_slot;
        first = span.first_segment + (at > 3 ? at - 3 : 0);
        last = span.first_segment + (at < span.segments ? at : span.segments - 1);
    }
};

/// The columns of a row, rising: the rows of all slots of its own segments, and of the segments near to these.
template <class Real>
struct ColumnsOfRow {
    ClothView<Real> cloth;
    NearView near;

    /// A row's own segments, rising, with how much of their near ones has been gone through.
    struct Around {
        std::uint32_t count = 0;
        std::uint32_t segment[4], next[4], end[4];  // a point has four segments, however often they see it
    };

    template <class Emit>
    WEAVE_HD void visit(std::uint32_t row, Emit& emit) const {
        Around around = around_row(row);
        std::uint32_t segment = next_segment(around, 0);
        while (segment < cloth.segments) {
            const std::uint32_t yarn = cloth.segment[segment].yarn;
            const YarnSpan span = cloth.span[yarn];
            // Rows at the ends of a yarn may have slots at both ends; those between have one each.
            const std::uint32_t end = span.first_row + span.rows, head = span.first_row + (span.rows < 2 ? span.rows : 2),
                                tail = span.rows < 4 ? head : end - 2;
            for (std::uint32_t r = span.first_row; r < head; ++r) {
                if (reaches(around, span, r)) emit(r);
            }
            std::uint32_t listed = head;
            for (; segment < cloth.segments && cloth.segment[segment].yarn == yarn; segment = next_segment(around, segment + 1)) {
                for (std::uint32_t slot = cloth.segment[segment].slot, past = slot + 4; slot < past; ++slot) {
                    const SlotShares& shares = cloth.shares[slot];
                    const std::uint32_t r = shares.row[0];
                    if (shares.weight[0] == 0 || cloth.slot_of_row[r] != slot || r < listed || r >= tail) continue;
                    emit(r);
                    listed = r + 1;
                }
            }
            for (std::uint32_t r = tail; r < end; ++r) {
                if (reaches(around, span, r)) emit(r);
            }
        }
    }

  private:
    WEAVE_HD Around around_row(std::uint32_t row) const {
        Around around;
        const YarnSpan span = cloth.span[cloth.yarn_of_row[row]];
        for (std::uint32_t i = cloth.first_slot_of_row[row]; i < cloth.first_slot_of_row[row + 1]; ++i) {
            const SegmentsOfSlot segments(span, cloth.slots_of_row[i].slot);
            for (std::uint32_t s = segments.first; s <= segments.last; ++s) insert(around, s);
        }
        for (std::uint32_t i = 0; i < around.count; ++i) {
            around.next[i] = near.first[around.segment[i]];
            around.end[i] = near.first[around.segment[i] + 1];
        }
        return around;
    }

    WEAVE_HD static void insert(Around& around, std::uint32_t segment) {
        std::uint32_t at = around.count;
        for (std::uint32_t i = 0; i < around.count; ++i) {
            if (around.segment[i] == segment) return;
            if (around.segment[i] > segment && at == around.count) at = i;
        }
        for (std::uint32_t i = around.count; i > at; --i) around.segment[i] = around.segment[i - 1];
        around.segment[at] = segment;
        ++around.count;
    }

    /// The first segment around that is no less than `from`, which must not fall; `cloth.segments` if there is none.
    WEAVE_HD std::uint32_t next_segment(Around& around, std::uint32_t from) const {
        std::uint32_t best = cloth.segments;
        for (std::uint32_t i = 0; i < around.count; ++i) {
            if (around.segment[i] >= from && around.segment[i] < best) best = around.segment[i];
            while (around.next[i] < around.end[i] && near.segment[around.next[i]] < from) ++around.next[i];
            if (around.next[i] < around.end[i] && near.segment[around.next[i]] < best) best = near.segment[around.next[i]];
        }
        return best;
    }

    /// Whether any of the segments around bends a row of the yarn.
    WEAVE_HD bool reaches(const Around& around, const YarnSpan& span, std::uint32_t row) const {
        for (std::uint32_t k = cloth.first_slot_of_row[row]; k < cloth.first_slot_of_row[row + 1]; ++k) {
            const SegmentsOfSlot segments(span, cloth.slots_of_row[k].slot);
            for (std::uint32_t i = 0; i < around.count; ++i) {
                if (around.segment[i] >= segments.first && around.segment[i] <= segments.last) return true;
                const std::uint32_t at =
                    first_from(near.segment, near.first[around.segment[i]], around.end[i], segments.first);
                if (at < around.end[i] && near.segment[at] <= segments.last) return true;
            }
        }
        return false;
    }
};

template <class Real>
struct CountColumns {
    ColumnsOfRow<Real> columns;
    MatrixView matrix;

    struct Count {
        std::uint32_t count = 0;
        WEAVE_HD void operator()(std::uint32_t) { ++count; }
    };

    WEAVE_HD void operator()(std::size_t row) const {
        Count count;
        if (row < matrix.rows) columns.visit(static_cast<std::uint32_t>(row), count);
        matrix.first[row] = count.count;
    }
};

template <class Real>
struct FillColumns {
    ColumnsOfRow<Real> columns;
    MatrixView matrix;

    struct Fill {
        MatrixView matrix;
        std::uint32_t row, at;
        WEAVE_HD void operator()(std::uint32_t column) {
            if (column == row) matrix.diagonal[row] = at;
            matrix.column[at++] = column;
        }
    };

    WEAVE_HD void operator()(std::size_t row) const {
        Fill fill{matrix, static_cast<std::uint32_t>(row), matrix.first[row]};
        columns.visit(static_cast<std::uint32_t>(row), fill);
    }
};

/// How many slot blocks a segment needs by itself: its own and those of its pairs.
struct SlotBlocksOfSegment {
    NearView near;
    WEAVE_HD double operator()(std::size_t segment) const {
        return 1.0 + near.first_pair[segment + 1] - near.first_pair[segment];
    }
};

}  // namespace weave::sim
