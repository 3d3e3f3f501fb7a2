#pragma once

#include <QString>

#include <weave/sim/inspect.hpp>

#include <cstddef>
#include <optional>
#include <studio/jobs/happenings.hpp>
#include <vector>

namespace weave::studio {

/// What is known of a run, for a sentence on it.
struct RunState {
    RunPhase phase = RunPhase::idle;
    Progress progress;
    std::optional<Error> error;                    ///< of a failed one
    std::shared_ptr<const Yarns> yarns;            ///< as it stands, where it stands
    std::shared_ptr<const Inspection> inspection;  ///< of these
};

/// Where the state is to be looked at: picks and ends from 0.
struct ClothPlace {
    std::size_t pick = 0, end = 0;
    friend bool operator==(const ClothPlace&, const ClothPlace&) = default;
};

/// A sentence with the place that it speaks of.
struct StateLine {
    QString text;
    std::optional<ClothPlace> place;
};

/// One plain sentence on the state of a run.
QString state_words(const RunState& state);

/// The same of a run that shows the design before a change.
QString dated_words(const RunState& state);

/// What a weaver wants to know of cloth at rest, the gravest first.
std::vector<StateLine> inspection_words(const Inspection& inspection);

/// What is modelled, each with its reason; and what it is expected to take.
std::vector<QString> plan_words(const PlanSummary& plan);

/// `about 12 s`, `about 3 min`.
QString duration_words(double seconds);

/// An error as a window shows it: the place, then the cause, with picks and ends as people count them.
QString error_words(const Error& error);

}  // namespace weave::studio
