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

/// Where in a sample's list those begin that are, or are images of, own samples from `least` on.
template <class Real>
WEAVE_HD inline std::uint32_t first_neighbour_from(const ListsView<Real>& lists, std::uint32_t sample, std::uint32_t least) {
    std::uint32_t begin = lists.first[sample], end = lists.first[sample + 1];
    while (begin < end) {
        const std::uint32_t middle = begin + (end - begin) / 2;
        if (lists.own_of(lists.neighbour[middle]) < least) begin = middle + 1;
        else end = middle;
    }
    return begin;
}

/// The segments near to one of them, from the lists of its samples.
template <class Real>
struct NearOfSegment {
    ClothView<Real> cloth;
    ListsView<Real> lists;

    /// The first near segment that is no less than `from`; `cloth.segments` if there is none. Neighbours of a sample rise.
    WEAVE_HD std::uint32_t next(std::uint32_t segment, std::uint32_t from) const {
        std::uint32_t best = cloth.segments;
        if (from >= cloth.segments) return best;
        const SegmentPlace place = cloth.segment[segment];
        const std::uint32_t least = cloth.segment[from].sample, samples = cloth.yarn[place.yarn].samples;
        for (std::uint32_t a = place.sample; a < place.sample + samples && best != from; ++a) {
            const std::uint32_t end = lists.first[a + 1], at = first_neighbour_from(lists, a, least);
            if (at == end) continue;
            const std::uint32_t found = cloth.segment_of_sample[lists.own_of(lists.neighbour[at])];
            if (found < best) best = found;
        }
        return best;
    }
};

template <class Real>
struct CountNear {
    NearOfSegment<Real> of;
    NearView near;

    WEAVE_HD void operator()(std::size_t index) const {
        const auto segment = static_cast<std::uint32_t>(index);
        std::uint32_t count = 0, pairs = 0;
        if (segment < of.cloth.segments) {
            const std::uint32_t yarn = of.cloth.segment[segment].yarn;
            for (std::uint32_t o = of.next(segment, 0); o < of.cloth.segments; o = of.next(segment, o + 1)) {
                ++count;
                if (of.cloth.segment[o].yarn <= yarn) ++pairs;
            }
        }
        near.first[segment] = count;
        near.first_pair[segment] = pairs;
    }
};

template <class Real>
struct FillNear {
    NearOfSegment<Real> of;
    NearView near;

    WEAVE_HD void operator()(std::size_t index) const {
        const auto segment = static_cast<std::uint32_t>(index);
        std::uint32_t at = near.first[segment];
        for (std::uint32_t o = of.next(segment, 0); o < of.cloth.segments; o = of.next(segment, o + 1)) near.segment[at++] = o;
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
