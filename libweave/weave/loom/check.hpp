#pragma once

#include <weave/design/design.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/loom/profile.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
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

/// What a relaxed simulation tells of the whole design, as plain data.
struct RelaxedCloth {
    TakeUps take_up;  ///< of each end
    /// Yarn that goes into one repeat of the design, without tension, mm: of each end, NaN of one that is loose all
    /// along; and drawn from each feeder by all its picks. A pick that is loose all along counts with the width.
    std::vector<double> end_mm, feeder_mm;
    double length_mm = 0, width_mm = 0;  ///< of one repeat along the ends, and along the picks
    bool width_found = false;  ///< the simulation let the cloth find its width; else it is that which was given
};

/// What came of writing the controller's file of a design and reading it again with a decoder that shares no code
/// with the writer. Only programs that write such files know it; they hand it in as plain data.
struct ReadBack {
    enum class Outcome : std::uint8_t { equal, differs, no_file };
    Outcome outcome = Outcome::no_file;
    std::string words;  ///< what differs, or why there is no file; empty where all is equal
};

/// Ends of one beam may differ in take-up by so much where the profile sets no limit. A beam lets all its ends off
/// alike, so what one takes up less hangs in the shed as slack unless the warp's own stretch takes it in: warp is
/// held at a strain of about a hundredth (the paper's S = 1.01), and beyond that difference there is none left.
inline constexpr double usual_take_up_difference = 0.01;

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
                           const std::optional<RelaxedCloth>& relaxed = {},
                           const std::optional<ReadBack>& read_back = {});

}  // namespace weave
