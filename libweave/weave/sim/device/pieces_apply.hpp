#pragma once

#include <weave/sim/device/pieces.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace weave::sim {

/// So many pieces are few: one block is sooner done with them than all blocks with waiting for one another.
inline constexpr std::uint32_t few_pieces = 1024;

/// One number of a piece's residual: the sum of its members'.
template <class Real>
struct RestrictPiece {
    PiecesView<Real> view;
    View<const Real> finer;  ///< residual of its members
    std::uint32_t first;     ///< piece

    WEAVE_HD void operator()(std::size_t i) const {
        const std::size_t piece = first + i / 3, k = i % 3;
        Real sum = 0;
        for (std::uint32_t m = view.first_member[piece], end = view.first_member[piece + 1]; m < end; ++m) {
            const PieceShare<Real> member = view.member[m];
            sum += member.weight * finer[3 * std::size_t(member.of) + k];
        }
        view.residual[3 * piece + k] = sum;
    }
};

/// Number `i` of the product with the inverse of what is solved as a whole.
template <class Real>
WEAVE_HD inline Real solve_whole(const View<double>& whole, const PieceRange& level, const View<const Real>& residual, std::size_t i) {
    const std::size_t size = 3 * std::size_t(level.end - level.first);
    const double* inverse = whole.at(level.whole_from + size * i, size);  // symmetric: a row is a column
    const Real* of = residual.at(3 * std::size_t(level.first), size);
    double sum = 0;
    for (std::size_t k = 0; k < size; ++k) sum += inverse[k] * double(of[k]);
    return static_cast<Real>(sum);
}

/// One number of a row's or a piece's step: what it does by itself, and what the pieces do that it belongs to.
template <class Real>
struct StepOfRow {
    PiecesView<Real> view;
    View<const Real> residual;
    View<Real> step;
    std::uint32_t first;  ///< row of `residual` and `step`
    std::uint32_t shift;  ///< 0 for rows, all rows for pieces

    WEAVE_HD void operator()(std::size_t i) const {
        const std::size_t row = first + i / 3, k = i % 3, number = shift + row;
        const Real *of = residual.at(3 * row, 3), *a = view.inverse.at(9 * number, 9);
        Real sum = a[k] * of[0] + a[k + 3] * of[1] + a[k + 6] * of[2];
        if (shift > 0) {
            const PieceRange level = view.level[view.level_of[row]];
            if (level.is_whole != 0) sum = solve_whole<Real>(view.whole, level, residual, 3 * (row - level.first) + k);
        }
        for (std::uint32_t t = view.first_target[number], end = view.first_target[number + 1]; t < end; ++t) {
            const PieceShare<Real> target = view.target[t];
            sum += target.weight * view.step[3 * std::size_t(target.of) + k];
        }
        step[3 * row + k] = sum;
    }
};

/// Few rows that are solved as a whole without pieces.
template <class Real>
struct StepOfFew {
    PiecesView<Real> view;
    View<const Real> residual;
    View<Real> step;
    WEAVE_HD void operator()(std::size_t i) const { step[i] = solve_whole<Real>(view.whole, view.depths.whole[0], residual, i); }
};

template <class Crew, class Real>
WEAVE_HD void restrict_to(Crew& crew, const PiecesView<Real>& view, std::type_identity_t<View<const Real>> residual, std::uint32_t depth) {
    crew.each(3 * std::size_t(view.depths.pieces_at(depth)),
              RestrictPiece<Real>{view, depth == 1 ? residual : View<const Real>(view.residual), view.depths.first[depth - 1]});
}

template <class Crew, class Real>
WEAVE_HD void step_of(Crew& crew, const PiecesView<Real>& view, std::uint32_t depth) {
    crew.each(3 * std::size_t(view.depths.pieces_at(depth)),
              StepOfRow<Real>{view, view.residual, view.step, view.depths.first[depth - 1], view.depths.rows});
}

/// The depths of few pieces, by one block: residuals from `restrict_from` on down, then steps back up to depth `steps_to`.
template <class Real>
struct StepOfFewPieces {
    PiecesView<Real> view;
    std::uint32_t restrict_from, steps_to;

    template <class Crew>
    WEAVE_HD void operator()(Crew& crew) const {
        for (std::uint32_t depth = restrict_from; depth <= view.depths.depths; ++depth)
            restrict_to(crew, view, view.residual, depth);
        for (std::uint32_t depth = view.depths.depths; depth >= steps_to; --depth) step_of(crew, view, depth);
    }
};

/// step = the multigrid's inverse times `residual`, 3 numbers a row. Barriers: with d depths of more than few_pieces pieces 2d + 3, one of
/// them for the block that does all other depths: 3 for cells of up to 4,000 points, 13 for a million points; 1 for so few rows that they
/// are solved as a whole.
template <class Crew, class Real>
WEAVE_HD void apply(Crew& crew, const PiecesView<Real>& view, std::type_identity_t<View<const Real>> residual,
                    std::type_identity_t<View<Real>> step) {
    const PieceDepths& depths = view.depths;
    if (depths.depths == 0) {
        crew.each(3 * std::size_t(depths.rows), StepOfFew<Real>{view, residual, step});
        return;
    }
    std::uint32_t many = 0;  // depths of many pieces
    while (many < depths.depths && depths.pieces_at(many + 1) > few_pieces) ++many;
    // One more is restricted by all: its members are many.
    const std::uint32_t by_all = many < depths.depths ? many + 1 : many;
    for (std::uint32_t depth = 1; depth <= by_all; ++depth) restrict_to(crew, view, residual, depth);
    if (many < depths.depths) crew.in_one_block(StepOfFewPieces<Real>{view, by_all + 1, many + 1});
    for (std::uint32_t depth = many; depth >= 1; --depth) step_of(crew, view, depth);
    crew.each(3 * std::size_t(depths.rows), StepOfRow<Real>{view, residual, step, 0, 0});
}

}  // namespace weave::sim
