#pragma once

#include <weave/sim/device/crew_cloth.hpp>
#include <weave/sim/relax.hpp>
#include <weave/sim/relaxing.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace weave::sim {

/// How far a relaxation had come after so many steps.
struct StepRecord {
    std::uint64_t iteration;
    double residual, energy;  ///< energy in N·mm
};

struct WriteRecord {
    View<StepRecord> history;
    std::uint32_t at;
    StepRecord record;

    WEAVE_HD void operator()() const { history[at] = record; }
};

/// A relaxation by a crew, as numbers that one kernel leaves to the next.
template <class Cloth>
struct Leg {
    /// What comes next.
    enum class Phase : std::uint8_t { begin, judge, saddle, step, finish, over };

    Relaxing<Cloth> relaxing;
    CrewState cloth;
    Phase phase = Phase::begin;
    Ending ending = Ending::converged;  ///< once it is over
    bool lacks_room = false;            ///< room must be made before it goes on
    double strain = 0;                  ///< greatest of yarns of fixed length at the start
    std::uint64_t most_iterations = std::numeric_limits<std::uint64_t>::max();
    std::uint32_t records = 0;          ///< that this kernel has written

    /// It ends with the state as it is.
    WEAVE_HD void end(Ending how) {
        ending = how;
        phase = Phase::finish;
    }
};

/// Goes on with a relaxation: to its end, or until `steps` steps were made, or room is lacking. Of `history` a record for each step
/// and one more are written.
WEAVE_ANYWHERE template <class Real, class Crew>
WEAVE_HD void run_leg(Crew& crew, const CrewRoom<Real>& room, Leg<CrewCloth<Real, Crew>>& leg, std::uint32_t steps,
                      const View<StepRecord>& history) {
    using Cloth = CrewCloth<Real, Crew>;
    using Phase = typename Leg<Cloth>::Phase;
    Cloth cloth(crew, room, leg.cloth);
    Relaxing<Cloth>& relaxing = leg.relaxing;
    const bool repeats = leg.lacks_room;
    leg.lacks_room = repeats && relaxing.evaluate(cloth) == Step::lacks_room;
    leg.records = 0;
    while (!leg.lacks_room && leg.phase != Phase::over) {
        Step how = Step::done;
        switch (leg.phase) {
            case Phase::begin:
                how = relaxing.begin(cloth, leg.strain);
                if (how != Step::lacks_room) leg.phase = Phase::judge;
                break;
            case Phase::judge:
                how = relaxing.judge(cloth);
                if (how == Step::lacks_room) break;
                crew.alone(WriteRecord{history, leg.records++, {relaxing.iterations, relaxing.residual, relaxing.energy}});
                leg.phase = relaxing.is_at_goal() ? Phase::saddle : Phase::step;
                break;
            case Phase::saddle:
                how = relaxing.leave_saddle(cloth);
                if (how == Step::none) leg.end(Ending::converged);
                if (how == Step::done) leg.phase = Phase::step;
                break;
            case Phase::step:
                if (relaxing.iterations >= leg.most_iterations) {
                    leg.end(Ending::iterations);
                    break;
                }
                if (steps == 0) {
                    leg.cloth = cloth.state();
                    return;
                }
                how = relaxing.step(cloth);
                if (how == Step::none) leg.end(Ending::stuck);
                if (how != Step::done) break;
                --steps;
                leg.phase = Phase::judge;
                break;
            case Phase::finish:
                how = relaxing.finish(cloth);
                if (how != Step::lacks_room) leg.phase = Phase::over;
                break;
            case Phase::over: break;
        }
        leg.lacks_room = how == Step::lacks_room;
    }
    leg.cloth = cloth.state();
}

/// The same as a kernel.
template <class Real>
struct RunLeg {
    CrewRoom<Real> room;
    View<StepRecord> history;
    std::uint32_t steps;

    WEAVE_ANYWHERE template <class Crew>
    WEAVE_HD void operator()(Crew& crew, Leg<CrewCloth<Real, Crew>>& leg) const {
        run_leg(crew, room, leg, steps, history);
    }
};

}  // namespace weave::sim
