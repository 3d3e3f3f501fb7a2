#pragma once

// The steps of a relaxation (safe_step.hpp, descent.hpp, newton.hpp, relaxing.hpp) decide from a few numbers what is done
// with a cloth; all work on the cloth itself is an operation of the cloth. So one source leads it on the processor
// (host_cloth.hpp), as kernels launched from the host, and inside one kernel whose threads all run these steps alike. For
// that, steps hold plain numbers alone, allocate nothing and throw nothing.
//
// What a `Cloth` offers; safe_share(), shorten() and assemble() only at a state that was evaluated last. Where many threads lead
// it, all of them call each operation, in the same order with the same arguments, and all get the same numbers back.
//
// Vectors are public members, of whatever type; steps only hand them back to operations.
//   slots, three numbers each: state (mm); gradient, trial (∂E, N; zero where a slot does not move);
//                              before (a state); change, cut (of the state, mm)
//   rows of the matrix, one for each point that moves: residual (N); solved, direction, step (mm); product (N)
//
// | Operation               | Meaning                                                                                 |
// |-------------------------|-----------------------------------------------------------------------------------------|
// | noise                   | constant: changes of energy below this share of it are rounding                         |
// | lacks_room()            | whether the latest evaluation or matrix is void since lists overflowed; constexpr false |
// |                         | where lists grow. Asked after each of these                                             |
// | is_empty()              | whether nothing can move: the matrix has no rows                                        |
// | least_reach()           | smallest sum of two radii, mm                                                           |
// | reference_force()       | what residuals are measured by, N (relax.hpp); evaluates contact at the state           |
// | give_beyond(strain)     | yarns of fixed length give way beyond this strain (StretchLaw); infinite: nowhere       |
// | evaluate()              | energy at the state, N·mm; gradient := its derivative                                   |
// | evaluate_trial()        | the same into trial                                                                     |
// | go(share)               | state := before + share · change, slots that follow placed; then evaluate_trial()       |
// | keep_state(), back()    | before := state; state := before                                                        |
// | accept_trial()          | gradient := trial; trial is void                                                        |
// | dot(a, b)               | Σ a·b, both of slots or both of rows                                                    |
// | greatest_force(slots)   | greatest length of one slot's three numbers: N of forces, mm of changes                 |
// | safe_share(slots, most) | how much of this change, at most `most`, lets no yarns pass through one another         |
// | shorten(slots)          | shortens this change where it is not safe, there alone                                  |
// | stop_uphill(slots)      | this change := 0 at slots where it leads up the gradient, then followed                 |
// | scale(slots, share)     | times a share                                                                           |
// | cut_from_change()       | cut := change                                                                           |
// | accept_cut()            | change := cut; cut is void                                                              |
// | assemble(curvature)     | matrix A := second derivatives at the state                                             |
// | add_to_pivots(share)    | adds a share of each pivot's mean to it                                                 |
// | factor()                | preconditioner M := of the matrix as it is now                                          |
// | find_direction()        | change := downhill by the gradient, M and the pairs that are remembered (L-BFGS)        |
// | remember(share)         | pair: share · change, and trial less gradient; unless the energy hardly curves upwards  |
// | forget_pairs()          | none is remembered                                                                      |
// | start_from_gradient()   | step := 0, residual := −gradient                                                        |
// | start_at_random()       | step := 0, residual := numbers from −1 to 1, the same every time                        |
// | precondition()          | solved := M⁻¹ residual; residual · solved                                               |
// | turn(share)             | direction := solved + share · direction; 0: solved, whatever direction holds            |
// | curvature()             | product := A direction; direction · product                                             |
// | move(share)             | step += share · direction, residual −= share · product                                  |
// | change_from(rows)       | change := these rows, 0 at other slots, then followed                                   |
// | aim_along_change()      | direction := change                                                                     |

#include <weave/sim/bodies.hpp>

#include <cstdint>

namespace weave::sim {

/// Which second derivatives a matrix holds.
enum class Curvature : std::uint8_t {
    convex,  ///< only what curves upwards: far from rest every step then leads down
    exact,   ///< all of them: near rest, for convergence
};

/// How a step ended.
enum class Step : std::uint8_t {
    done,
    none,        ///< nothing leads down; the state is what it was
    lacks_room,  ///< the cloth's lists are too short; the state is what it was. With room made and the state evaluated, again
};

/// The number that a random start has at a place, from −1 to 1 (splitmix64): the same on every machine.
WEAVE_HD inline double some_number(std::uint64_t place) {
    std::uint64_t mixed = (place + 1) * 0x9e3779b97f4a7c15ULL;
    mixed = (mixed ^ mixed >> 30) * 0xbf58476d1ce4e5b9ULL;
    mixed = (mixed ^ mixed >> 27) * 0x94d049bb133111ebULL;
    mixed ^= mixed >> 31;
    return static_cast<double>(mixed >> 11) / static_cast<double>(1ULL << 52) - 1;
}

/// By value: the standard's take references, which constants have none of on a device.
template <class Number>
WEAVE_HD constexpr Number lesser(Number a, Number b) {
    return b < a ? b : a;
}
template <class Number>
WEAVE_HD constexpr Number greater(Number a, Number b) {
    return a < b ? b : a;
}
template <class Number>
WEAVE_HD constexpr Number clamped(Number number, Number least, Number most) {
    return number < least ? least : most < number ? most : number;
}

}  // namespace weave::sim
