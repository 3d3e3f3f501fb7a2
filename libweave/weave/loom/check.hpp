#pragma once

#include <weave/design/design.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/loom/profile.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace weave {

/// One thing that validation has to say.
struct Finding {
    std::string rule;  ///< such as `float.face`
    Severity severity = Severity::warning;
    std::optional<std::size_t> pick;  ///< from 0; programs print from 1
    std::optional<std::size_t> end;
    std::string message;  ///< a sentence that a weaver understands
};

/// A rule that could not be judged, and what it lacks.
struct NotEvaluated {
    std::string rule;
    std::string reason;
};

/// Take-up of each end from a relaxed simulation, as plain data: (yarn length - cloth length) / cloth length. NaN of an
/// end that is loose all along and takes up nothing.
using TakeUps = std::vector<double>;

struct CheckReport {
    /// Worst first, then by rule, pick, end. No rule lists more than a hundred; one more says how many there
    /// were besides.
    std::vector<Finding> findings;
    std::array<std::size_t, 4> counts{};  ///< of all that was found, listed or not, by Severity
    std::vector<NotEvaluated> not_evaluated;
    std::vector<std::string> passed;  ///< rules that were evaluated and found nothing
    [[nodiscard]] std::size_t count(Severity severity) const {
        return counts[static_cast<std::size_t>(severity)];
    }
};

/// Everything that validation knows about.
struct Rule {
    std::string id;
    Severity severity;  ///< by default; a profile may say otherwise
    std::string help;   ///< what it asks for, one line
};
const std::vector<Rule>& rules();

/// Holds a design to a loom: every rule of rules() is judged, or listed as not evaluated with the reason,
/// never passed silently.
CheckReport check_for_loom(const Design& design, const Evaluation& cloth, const LoomProfile& profile,
                           const std::optional<TakeUps>& take_ups = {});

}  // namespace weave
