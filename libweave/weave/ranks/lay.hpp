#pragma once

#include <weave/ranks/comm.hpp>
#include <weave/ranks/cut.hpp>
#include <weave/ranks/exchange.hpp>
#include <weave/ranks/piece.hpp>

#include <memory>
#include <vector>

namespace weave::ranks {

/// The pieces of a rank's blocks, with the guests that they have as yarns lie now, and what brings these their numbers. It holds
/// until a point has gone farther than `travel_mm()`; then yarns that are not there may come to touch, and it is made anew.
struct Lay {
    std::vector<std::unique_ptr<Piece>> pieces;
    Exchange exchange;
};

/// How far points may go before a lay is made anew, mm.
double travel_mm(const Cut& cut);

/// The three points before and after each run of a block's own points never change.
std::vector<std::vector<Met>> points_along(const std::vector<Part>& parts);

/// Lays out the blocks of this rank; all ranks call it at once. `own`: where this rank's points lie, three numbers each, block
/// after block; `along` brings the places of points_along(). Each block offers every other what of its segments may come near
/// that one's: a box around each tells.
std::unique_ptr<Lay> lay_out(Comm& comm, const Cut& cut, const std::vector<Part>& parts, Exchange& along, const std::vector<double>& own,
                             const sim::Executor& executor);

}  // namespace weave::ranks
