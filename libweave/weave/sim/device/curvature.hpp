#pragma once

// Second derivatives of the energy by the control points that move, as a matrix (see Hessian, which scatters what each segment
// adds). Here every block of the matrix gathers what segments have added up, so that no two threads write one place. Friction and
// flips are not in it.

#include <weave/sim/device/slot_blocks.hpp>

#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// The segments whose slot blocks are there at once: from `first` on, before `end`.
struct CurvatureChunk {
    std::uint32_t first, end;            ///< segments
    std::uint32_t first_pair, end_pair;
    std::uint32_t first_row, end_row;    ///< of their yarns
};

/// Where the second derivatives of a cloth are laid; made by CurvatureArrays.
template <class Real>
struct CurvatureView {
    MatrixView matrix;
    NearView near;
    View<SampleSums<Real>> sums;     ///< per own sample
    View<float> slot_blocks;         ///< 144 each: block (c, d) of slots at 9 (4 c + d), column by column
    View<CurvatureChunk> chunk;      ///< one
    CurvatureNeeds room;             ///< what arrays have room for
    std::uint64_t most_slot_blocks;  ///< so many at once at most, if no segment needs more
    View<CurvatureNeeds> needed;     ///< one: written where there is not enough room
};

/// Lanes that share the blocks of a row.
inline constexpr std::size_t row_lanes = 16;

/// Blocks up to the diagonal, from slot blocks, and those on its other side.
template <class Real>
struct GatherRow {
    ClothView<Real> cloth;
    NearView near;
    MatrixView matrix;
    View<const float> slot_blocks;
    CurvatureChunk chunk;
    bool adds;  ///< to what other chunks have gathered

    WEAVE_HD void operator()(std::size_t i) const {
        const auto row = static_cast<std::uint32_t>(chunk.first_row + i / row_lanes);
        const YarnSpan span = cloth.span[cloth.yarn_of_row[row]];
        for (std::uint32_t at = matrix.first[row] + static_cast<std::uint32_t>(i % row_lanes), end = matrix.diagonal[row]; at <= end;
             at += row_lanes) {
            Real sum[9]{};
            const std::uint32_t column = matrix.column[at];
            const YarnSpan other = cloth.span[cloth.yarn_of_row[column]];
            bool any = false;
            for (std::uint32_t k = cloth.first_slot_of_row[row]; k < cloth.first_slot_of_row[row + 1]; ++k) {
                const RowSlot slot = cloth.slots_of_row[k];
                const SegmentsOfSlot segments(span, slot.slot);
                for (std::uint32_t s = segments.first; s <= segments.last; ++s) {
                    if (s < chunk.first || s >= chunk.end) continue;
                    any = true;
                    add_segment(s, slot, span, column, other, sum);
                }
            }
            if (any || !adds) put_both(matrix, row, at, sum, adds);
        }
    }

  private:
    WEAVE_HD static std::uint32_t place_of(const YarnSpan& span, std::uint32_t segment, std::uint32_t slot) {
        return slot - span.first_slot - (segment - span.first_segment);
    }

    /// What segment `s` adds by one of the row's slots and all of the column's.
    WEAVE_HD void add_segment(std::uint32_t s, const RowSlot& slot, const YarnSpan& span, std::uint32_t column, const YarnSpan& other,
                              Real (&sum)[9]) const {
        const std::uint32_t c = place_of(span, s, slot.slot), first = near.first[s], first_pair = near.first_pair[s],
                            end = first + (near.first_pair[s + 1] - first_pair);
        for (std::uint32_t k = cloth.first_slot_of_row[column]; k < cloth.first_slot_of_row[column + 1]; ++k) {
            const RowSlot theirs = cloth.slots_of_row[k];
            const SegmentsOfSlot segments(other, theirs.slot);
            const Real weight = Real(slot.weight) * Real(theirs.weight);
            if (s >= segments.first && s <= segments.last)
                add(chunk.end_pair - chunk.first_pair + (s - chunk.first), c, place_of(other, s, theirs.slot), weight, sum);
            for (std::uint32_t p = first_from(near.segment, first, end, segments.first);
                 p < end && near.segment[p] <= segments.last; ++p) {
                add(first_pair - chunk.first_pair + (p - first), c, place_of(other, near.segment[p], theirs.slot), weight, sum);
            }
        }
    }

    WEAVE_HD void add(std::size_t block, std::uint32_t c, std::uint32_t d, Real weight, Real (&sum)[9]) const {
        const float* from = slot_blocks.at(144 * block + 9 * std::size_t(4 * c + d), 9);
        for (int k = 0; k < 9; ++k) sum[k] += weight * Real(from[k]);
    }
};

/// The next segments whose slot blocks there is room for.
template <class Real>
struct NextChunk {
    ClothView<Real> cloth;
    NearView near;
    View<CurvatureChunk> chunk;
    std::uint64_t room;
    std::uint32_t first;

    WEAVE_HD void operator()() const {
        // Segments before `low` do, those before `high` + 1 do not.
        std::uint32_t low = first + 1, high = cloth.segments;
        while (low < high) {
            const std::uint32_t middle = low + (high - low + 1) / 2;
            if (std::uint64_t{middle - first} + (near.first_pair[middle] - near.first_pair[first]) <= room) low = middle;
            else high = middle - 1;
        }
        const YarnSpan begins = cloth.span[cloth.segment[first].yarn], ends = cloth.span[cloth.segment[low - 1].yarn];
        chunk[0] = {first, low, near.first_pair[first], near.first_pair[low], begins.first_row, ends.first_row + ends.rows};
    }
};

struct ClearBlock {
    MatrixView matrix;
    WEAVE_HD void operator()(std::size_t at) const {
        float* block = matrix.value.at(9 * at, 9);
        for (int k = 0; k < 9; ++k) block[k] = 0;
    }
};

struct TellNeeds {
    View<CurvatureNeeds> needed;
    CurvatureNeeds needs;
    WEAVE_HD void operator()() const { needed[0] = needs; }
};

/// Finds which blocks the matrix has, after lists were made anew. False where there is not enough room: CurvatureArrays::grow(),
/// then again.
template <class Crew, class Real>
WEAVE_HD bool make_shape(Crew& crew, const ClothView<Real>& cloth, const ListsView<Real>& lists, const CurvatureView<Real>& view) {
    const std::size_t segments = cloth.segments;
    const NearOfSegment<Real> of{cloth, lists};
    CurvatureNeeds needs;
    crew.each(segments + 1, CountNear<Real>{of, view.near});
    needs.near = crew.scan(view.near.first, segments + 1);
    needs.pairs = crew.scan(view.near.first_pair, segments + 1);
    const std::uint64_t whole = needs.pairs + segments;
    const auto largest = static_cast<std::uint64_t>(crew.greatest(segments, SlotBlocksOfSegment{view.near}));
    needs.slot_blocks = whole < view.most_slot_blocks ? whole : largest > view.most_slot_blocks ? largest : view.most_slot_blocks;
    bool fits = needs.near <= view.room.near && needs.pairs <= view.room.pairs && needs.slot_blocks <= view.room.slot_blocks;
    if (needs.near <= view.room.near && needs.pairs <= view.room.pairs) {
        crew.each(segments, FillNear<Real>{of, view.near});
        const ColumnsOfRow<Real> columns{cloth, view.near};
        crew.each(std::size_t(cloth.rows) + 1, CountColumns<Real>{columns, view.matrix});
        needs.blocks = crew.scan(view.matrix.first, std::size_t(cloth.rows) + 1);
        fits = fits && needs.blocks <= view.room.blocks;
        if (fits) crew.each(cloth.rows, FillColumns<Real>{columns, view.matrix});
    }
    if (!fits) crew.alone(TellNeeds{view.needed, needs});
    return fits;
}

/// Fills the matrix, whose shape has been made, at a state whose samples have been laid. Three barriers, and one to read how much is
/// at once; where not all slot blocks have room at once, four for each part of them.
template <class Crew, class Real>
WEAVE_HD void assemble(Crew& crew, const ClothView<Real>& cloth, const ListsView<Real>& lists, StateView state,
                       const CurvatureLaw<Real>& law, const CurvatureView<Real>& view) {
    if (cloth.rows == 0) return;
    crew.each(cloth.samples, SumSample<Real>{cloth, lists, state, view.sums, law.convex});
    CurvatureChunk chunk{0, cloth.segments, 0, crew.read(view.near.first_pair, cloth.segments), 0, cloth.rows};
    const bool at_once = std::uint64_t{chunk.end_pair} + cloth.segments <= view.room.slot_blocks;
    if (!at_once) crew.each(crew.read(view.matrix.first, cloth.rows), ClearBlock{view.matrix});
    for (std::uint32_t next = 0; next < cloth.segments; next = chunk.end) {
        if (!at_once) {
            crew.alone(NextChunk<Real>{cloth, view.near, view.chunk, view.room.slot_blocks, next});
            chunk = crew.read(view.chunk, 0);
        }
        const std::uint32_t pairs = chunk.end_pair - chunk.first_pair;
        crew.each(4 * (std::size_t(pairs) + chunk.end - chunk.first),
                  MakeSlotBlocks<Real>{cloth, lists, state, view.near, view.sums, view.slot_blocks, law, chunk.first, chunk.first_pair, pairs});
        crew.each((chunk.end_row - chunk.first_row) * row_lanes,
                  GatherRow<Real>{cloth, view.near, view.matrix, view.slot_blocks, chunk, !at_once});
    }
}

}  // namespace weave::sim
