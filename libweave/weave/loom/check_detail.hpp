#pragma once

// Shared by the sources of check_for_loom; no part of the library's face.

#include <weave/core/text.hpp>
#include <weave/loom/check.hpp>
#include <weave/loom/pick_table.hpp>
#include <weave/loom/weft_way.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace weave::check_detail {

/// No rule fills a report with more findings than this; the rest is counted.
inline constexpr std::size_t most_findings_per_rule = 100;

/// The one place of a finding; picks and ends from 0.
struct Place {
    std::optional<std::size_t> pick, end;
};
inline Place at_pick(std::size_t pick) {
    return {pick, {}};
}
inline Place at_end(std::size_t end) {
    return {{}, end};
}

/// Collects what one rule has to say. A rule that neither finds anything nor is said to be not evaluated has
/// passed.
class RuleReport {
  public:
    RuleReport(CheckReport& report, const LoomProfile& profile, std::string_view id);
    RuleReport(const RuleReport&) = delete;
    RuleReport& operator=(const RuleReport&) = delete;
    /// Closes the rule: says how many more findings there were, or that it passed.
    ~RuleReport();

    /// Whether the profile leaves this rule on; else it has been listed as not evaluated.
    [[nodiscard]] bool wanted() const { return m_severity != Severity::off; }
    void find(Place place, const std::string& message);
    /// What is worth knowing though the rule is kept.
    void tell(Place place, const std::string& message);
    void not_evaluated(std::string reason);

  private:
    CheckReport& m_report;
    std::string m_id;
    Severity m_severity = Severity::warning;
    std::size_t m_found = 0;
    bool m_evaluated = true;
};

/// Everything that rules look at, worked out once.
struct Subject {
    const Design& design;
    const Evaluation& cloth;
    const LoomProfile& profile;
    const std::optional<RelaxedCloth>& relaxed;
    const std::optional<ReadBack>& read_back;
    const Block& block;
    CardImage card;
    std::vector<Pick> picks;
    std::optional<CardImage> loose;  ///< loose_ends(), if the weft turns and there are any
    WeftWay way;         ///< through one repeat, with the loose ends trimmed; empty unless `turns`
    bool turns = false;  ///< the weft turns in the cloth: a shuttle loom, and a design in wraparound
};

inline std::string person(std::size_t number) {
    return std::to_string(number + 1);
}
/// A share as a percentage with one digit.
std::string percent(double share);
/// A number with so many digits after the point.
std::string decimal(double value, int digits = 1);

void check_structure(const Subject& subject, CheckReport& report);  ///< block.*, flips.*
void check_floats(const Subject& subject, CheckReport& report);     ///< float.*, bind.*
void check_hooks(const Subject& subject, CheckReport& report);      ///< hooks.*, picks.limit, name.limit
void check_selvedge(const Subject& subject, CheckReport& report);   ///< selvedge.*
void check_lifts(const Subject& subject, CheckReport& report);      ///< lift.*
void check_feeders(const Subject& subject, CheckReport& report);    ///< feeders.*
/// turn.*, insertion.match, repeat.doubled
void check_turns(const Subject& subject, CheckReport& report);
/// take-up.stop, take-up.regulator, reed.*, warp.density
void check_warp(const Subject& subject, CheckReport& report);
/// take-up.beam, cloth.width, consumption: what a relaxed simulation tells
void check_relaxed(const Subject& subject, CheckReport& report);

}  // namespace weave::check_detail
