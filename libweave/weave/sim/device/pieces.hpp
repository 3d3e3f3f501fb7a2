#pragma once

// The multigrid (see Multigrid) on any crew. Levels are numbered by their *depth*, which is 0 for the rows of the given matrix, 1 for
// the pieces formed of these, and so on; several levels (pieces of yarns, nodes of a grid) may have one depth. All pieces are rows of
// one matrix, those of a lower depth first, so that a pass over a depth is one call of the crew.

#include <weave/sim/device/crew.hpp>
#include <weave/sim/device/matrix.hpp>
#include <weave/sim/device/rows.hpp>
#include <weave/sim/pivots.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace weave::sim {

/// A row or a piece, and how much of it.
template <class Real>
struct PieceShare {
    std::uint32_t of;
    Real weight;
};

/// Pieces of one level.
struct PieceRange {
    std::uint32_t first, end;
    std::uint32_t is_whole;    ///< 1 where it is the last of its line and solved as a whole
    std::uint32_t whole_from;  ///< where its inverse begins, (3 · pieces)² numbers column by column
};

inline constexpr std::size_t most_depths = 20, most_whole = 4;

/// What the control code of the multigrid must know of its levels.
struct PieceDepths {
    std::uint32_t rows = 0;                     ///< of the given matrix
    std::uint32_t depths = 0;                   ///< beyond 0; 0: few rows, solved as a whole
    std::uint32_t first[most_depths + 1]{};     ///< pieces of depth d: from first[d - 1] on, before first[d]
    std::uint32_t wholes = 0;
    PieceRange whole[most_whole]{};             ///< levels that are solved as a whole; their pieces, or the rows where depths is 0

    [[nodiscard]] WEAVE_HD std::uint32_t pieces() const { return first[depths]; }
    [[nodiscard]] WEAVE_HD std::uint32_t pieces_at(std::uint32_t depth) const { return first[depth] - first[depth - 1]; }
};

/// What arrays must have room for.
struct PiecesNeeds {
    std::uint64_t blocks = 0;  ///< of the matrix of all pieces
    std::uint64_t found = 0;   ///< columns found of one depth, some more than once
};

/// The multigrid's numbers; made by PieceArrays.
template <class Real>
struct PiecesView {
    PieceDepths depths;
    View<const PieceRange> level;               ///< per level but that of the rows
    View<const std::uint32_t> level_of;         ///< per piece
    View<const std::uint32_t> first_member;     ///< per piece, and one more
    View<const PieceShare<Real>> member;        ///< rows (of depth 1) or pieces, rising
    View<const std::uint32_t> first_target;     ///< per row, then per piece, and one more
    View<const PieceShare<Real>> target;        ///< pieces that it belongs to
    MatrixView matrix;                          ///< of the pieces
    View<Real> inverse;                         ///< of pivots, 9 a row, then 9 a piece
    View<double> whole, spare_whole;            ///< inverses of what is solved as a whole
    View<Real> residual, step;                  ///< 3 a piece
    View<std::uint32_t> start, count, found;    ///< for the shape: per piece and one more; columns found
    PiecesNeeds room;
    View<PiecesNeeds> needed;                   ///< one: written where there is not enough room
};

/// The finer matrix and the shares of its rows, seen from pieces of some depth.
template <class Real>
struct FinerRows {
    MatrixView matrix;
    View<const std::uint32_t> first_target;     ///< per row of the matrix
    std::uint32_t shift;                        ///< how many rows come before in first_target
};

template <class Real>
WEAVE_HD inline FinerRows<Real> finer_rows(const PiecesView<Real>& view, const MatrixView& given, std::uint32_t depth) {
    return {depth == 1 ? given : view.matrix, view.first_target, depth == 1 ? 0 : view.depths.rows};
}

/// The columns of a piece: all pieces of its level that rows belong to which its own rows meet.
template <class Real>
struct ColumnsOfPiece {
    PiecesView<Real> view;
    FinerRows<Real> finer;

    /// emit(piece), mostly once for those that follow one another.
    template <class Emit>
    WEAVE_HD void visit(std::uint32_t piece, Emit& emit) const {
        const PieceRange level = view.level[view.level_of[piece]];
        std::uint32_t latest[4] = {piece, piece, piece, piece}, turn = 0;
        emit(piece);  // it has a pivot whatever its rows hold
        for (std::uint32_t m = view.first_member[piece]; m < view.first_member[piece + 1]; ++m) {
            const std::uint32_t row = view.member[m].of;
            for (std::uint32_t at = finer.matrix.first[row]; at < finer.matrix.first[row + 1]; ++at) {
                const std::uint32_t column = finer.shift + finer.matrix.column[at];
                for (std::uint32_t t = finer.first_target[column]; t < finer.first_target[column + 1]; ++t) {
                    const std::uint32_t of = view.target[t].of;
                    if (of < level.first || of >= level.end) continue;
                    if (of == latest[0] || of == latest[1] || of == latest[2] || of == latest[3]) continue;
                    latest[turn] = of;
                    turn = (turn + 1) % 4;
                    emit(of);
                }
            }
        }
    }
};

template <class Real>
struct CountFound {
    ColumnsOfPiece<Real> columns;
    std::uint32_t first, end;  ///< pieces

    struct Count {
        std::uint32_t count = 0;
        WEAVE_HD void operator()(std::uint32_t) { ++count; }
    };

    WEAVE_HD void operator()(std::size_t i) const {
        Count count;
        if (first + i < end) columns.visit(static_cast<std::uint32_t>(first + i), count);
        columns.view.start[i] = count.count;
    }
};

/// Lists the columns of a piece, rising, each once.
template <class Real>
struct ListFound {
    ColumnsOfPiece<Real> columns;
    std::uint32_t first, end;  ///< pieces

    struct Insert {
        View<std::uint32_t> found;
        std::uint32_t from, end;
        WEAVE_HD void operator()(std::uint32_t column) {
            const std::uint32_t at = end > from && found[end - 1] < column ? end : first_from(found, from, end, column);
            if (at < end && found[at] == column) return;
            for (std::uint32_t k = end; k > at; --k) found[k] = found[k - 1];
            found[at] = column;
            ++end;
        }
    };

    WEAVE_HD void operator()(std::size_t i) const {
        const PiecesView<Real>& view = columns.view;
        if (first + i >= end) {
            view.count[i] = 0;
            return;
        }
        Insert insert{view.found, view.start[i], view.start[i]};
        columns.visit(static_cast<std::uint32_t>(first + i), insert);
        view.count[i] = insert.end - insert.from;
    }
};

template <class Real>
struct CopyFound {
    PiecesView<Real> view;
    std::uint32_t first, end;  ///< pieces
    std::uint32_t blocks;      ///< of those before

    WEAVE_HD void operator()(std::size_t i) const {
        const std::uint32_t to = blocks + view.count[i], piece = static_cast<std::uint32_t>(first + i);
        view.matrix.first[piece] = to;  // the last of one depth is the first of the next
        if (piece >= end) return;
        const std::uint32_t count = view.count[i + 1] - view.count[i];
        for (std::uint32_t k = 0; k < count; ++k) {
            const std::uint32_t column = view.found[view.start[i] + k];
            view.matrix.column[to + k] = column;
            if (column == piece) view.matrix.diagonal[piece] = to + k;
        }
    }
};

template <class Real>
struct TellPiecesNeeds {
    View<PiecesNeeds> needed;
    PiecesNeeds needs;
    WEAVE_HD void operator()() const { needed[0] = needs; }
};

/// Finds the blocks of the pieces' matrix, after `given` got another shape. False where there is not enough room:
/// PieceArrays::grow(), then again. Six barriers a depth and those of two scans.
template <class Crew, class Real>
WEAVE_HD bool shape_pieces(Crew& crew, const MatrixView& given, const PiecesView<Real>& view) {
    PiecesNeeds needs;
    for (std::uint32_t depth = 1; depth <= view.depths.depths; ++depth) {
        const std::uint32_t first = view.depths.first[depth - 1], end = view.depths.first[depth];
        const std::size_t count = std::size_t(end - first) + 1;
        const ColumnsOfPiece<Real> columns{view, finer_rows(view, given, depth)};
        crew.each(count, CountFound<Real>{columns, first, end});
        const std::uint64_t found = crew.scan(view.start, count);
        needs.found = needs.found > found ? needs.found : found;
        bool fits = found <= view.room.found;
        if (fits) {
            crew.each(count, ListFound<Real>{columns, first, end});
            const std::uint64_t before = needs.blocks;
            needs.blocks += crew.scan(view.count, count);
            fits = needs.blocks <= view.room.blocks;
            if (fits) crew.each(count, CopyFound<Real>{view, first, end, static_cast<std::uint32_t>(before)});
        }
        if (fits) continue;
        crew.alone(TellPiecesNeeds<Real>{view.needed, needs});
        return false;
    }
    return true;
}

/// Lanes that share the blocks of a piece.
inline constexpr std::size_t piece_lanes = 16;

/// PᵀAP of pieces, P being the shares: blocks up to the diagonal, and those on its other side.
template <class Real>
struct CoarsenPiece {
    PiecesView<Real> view;
    MatrixView finer;
    std::uint32_t first;  ///< piece

    WEAVE_HD void operator()(std::size_t i) const {
        const auto piece = static_cast<std::uint32_t>(first + i / piece_lanes);
        const MatrixView& matrix = view.matrix;
        for (std::uint32_t at = matrix.first[piece] + static_cast<std::uint32_t>(i % piece_lanes), end = matrix.diagonal[piece]; at <= end;
             at += piece_lanes) {
            double sum[9]{};
            const std::uint32_t column = matrix.column[at], begin = view.first_member[column], past = view.first_member[column + 1];
            for (std::uint32_t m = view.first_member[piece]; m < view.first_member[piece + 1]; ++m)
                add_row(view.member[m], begin, past, sum);
            put_both(matrix, piece, at, sum, false);
        }
    }

  private:
    /// What one row adds with the rows of another piece, which are members from `begin` on, before `past`. Both lists rise.
    WEAVE_HD void add_row(const PieceShare<Real>& mine, std::uint32_t begin, std::uint32_t past, double (&sum)[9]) const {
        const std::uint32_t end = finer.first[mine.of + 1];
        if (begin == past) return;
        std::uint32_t at = first_from(finer.column, finer.first[mine.of], end, view.member[begin].of);
        for (std::uint32_t m = begin; m < past && at < end;) {
            const PieceShare<Real> theirs = view.member[m];
            const std::uint32_t column = finer.column[at];
            if (column < theirs.of) {
                at = finer.column[at + 1 < end ? at + 1 : at] < theirs.of ? first_from(finer.column, at + 1, end, theirs.of) : at + 1;
            } else if (column > theirs.of) {
                ++m;
            } else {
                const double weight = double(mine.weight) * double(theirs.weight);
                const float* block = finer.value.at(9 * std::size_t(at), 9);
                for (int k = 0; k < 9; ++k) sum[k] += weight * double(block[k]);
                ++at, ++m;
            }
        }
    }
};

/// Of rows, then of pieces.
template <class Real>
struct InvertPivot {
    PiecesView<Real> view;
    MatrixView given;

    WEAVE_HD void operator()(std::size_t i) const {
        const std::size_t rows = view.depths.rows;
        const MatrixView& matrix = i < rows ? given : view.matrix;
        const float* from = matrix.value.at(9 * std::size_t(matrix.diagonal[i < rows ? i : i - rows]), 9);
        Mat<double> pivot;
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) pivot(r, c) = (double(from[3 * c + r]) + double(from[3 * r + c])) / 2;
        }
        const Mat<double> inverse = inverse_of_pivot(pivot);
        Real* to = view.inverse.at(9 * i, 9);
        for (int k = 0; k < 9; ++k) to[k] = static_cast<Real>(inverse.data()[k]);
    }
};

/// A few rows of a matrix, all of whose columns are among them, as a full matrix with damping.
struct LayWhole {
    MatrixView matrix;
    std::uint32_t first, size;  ///< a row; numbers to a side
    View<double> whole;
    double damping;

    WEAVE_HD void operator()(std::size_t i) const {
        const auto row = static_cast<std::uint32_t>(i / 3), r = static_cast<std::uint32_t>(i % 3);
        for (std::uint32_t c = 0; c < size; ++c) whole[i + std::size_t(size) * c] = 0;
        for (std::uint32_t at = matrix.first[first + row]; at < matrix.first[first + row + 1]; ++at) {
            const std::size_t column = matrix.column[at] - first;
            for (std::size_t c = 0; c < 3; ++c) whole[i + size * (3 * column + c)] = double(matrix.value[9 * std::size_t(at) + 3 * c + r]);
        }
        whole[i + size * i] += damping;
    }
};

struct SizeOfWhole {
    View<double> whole;
    std::uint32_t size;
    WEAVE_HD double operator()(std::size_t i) const {
        const double number = whole[i + size * i];
        return number < 0 ? -number : number;
    }
};

/// One step of Gauss and Jordan's inversion in place, from one array to another.
struct Eliminate {
    View<const double> from;
    View<double> to;
    std::size_t size, pivot;

    WEAVE_HD void operator()(std::size_t i) const {
        const std::size_t row = i % size, column = i / size;
        const double inverse = 1 / from[pivot + size * pivot];
        if (row == pivot && column == pivot) to[i] = inverse;
        else if (row == pivot) to[i] = from[i] * inverse;
        else if (column == pivot) to[i] = -from[i] * inverse;
        else to[i] = from[i] - from[row + size * pivot] * from[pivot + size * column] * inverse;
    }
};

/// Inverts what is solved as a whole, by one block: its threads wait for one another after each pivot.
template <class Real>
struct InvertWholes {
    PiecesView<Real> view;
    MatrixView given;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        for (std::uint32_t w = 0; w < view.depths.wholes; ++w) {
            const PieceRange& level = view.depths.whole[w];
            const std::uint32_t size = 3 * (level.end - level.first);
            if (size == 0) continue;
            const std::size_t numbers = std::size_t(size) * size;
            const View<double> to = view.whole.slice(level.whole_from, numbers), spare = view.spare_whole.slice(0, numbers);
            const MatrixView& matrix = view.depths.depths == 0 ? given : view.matrix;
            crew.each(size, LayWhole{matrix, level.first, size, to, 0});
            const double sum = crew.sum(size, SizeOfWhole{to, size}), mean = sum > 1e-30 * size ? sum / size : 1e-30;
            // Whatever the matrix, some damping makes it positive.
            double more = 1e-6 * mean, damping = more;
            while (!invert(crew, LayWhole{matrix, level.first, size, to, damping}, spare) && 8 * more < 1e6 * mean) {
                more *= 8;
                damping += more;
            }
        }
    }

    /// Whether it is positive, which it is if all of its pivots are.
    template <class Crew>
    WEAVE_HD static bool invert(Crew& crew, const LayWhole& lay, const View<double>& spare) {
        const std::size_t size = lay.size;
        View<double> from = lay.whole, to = spare;
        crew.each(size, lay);
        for (std::size_t pivot = 0; pivot < size; ++pivot) {
            if (!(crew.read(from, pivot + size * pivot) > 0)) return false;
            crew.each(size * size, Eliminate{from, to, size, pivot});
            const View<double> turned = from;
            from = to;
            to = turned;
        }
        if (size % 2 != 0) crew.each(size * size, Copy<double>{from, to});
        return true;
    }
};

/// Makes the multigrid of a matrix whose pieces have been shaped. A barrier a depth, one for the pivots, one for what is solved as a
/// whole.
template <class Crew, class Real>
WEAVE_HD void factor(Crew& crew, const MatrixView& given, const PiecesView<Real>& view) {
    for (std::uint32_t depth = 1; depth <= view.depths.depths; ++depth) {
        crew.each(view.depths.pieces_at(depth) * piece_lanes,
                  CoarsenPiece<Real>{view, finer_rows(view, given, depth).matrix, view.depths.first[depth - 1]});
    }
    if (view.depths.depths > 0) crew.each(std::size_t(view.depths.rows) + view.depths.pieces(), InvertPivot<Real>{view, given});
    crew.in_one_block(InvertWholes<Real>{view, given});
}

}  // namespace weave::sim
