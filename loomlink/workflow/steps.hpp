#pragma once

#include <loomlink/workflow/cloths.hpp>
#include <loomlink/workflow/desk.hpp>
#include <loomlink/workflow/found.hpp>
#include <loomlink/workflow/rules.hpp>
#include <loomlink/workflow/validation.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// A revision by name, and why something is done to it.
struct StepWish {
    std::string design;
    std::int64_t number = 0;
    std::string reason;
};

/// What people do to a revision on its way to a loom; answers tell its new `state`. All but comments are
/// signed with the person's own key.
class Steps {
  public:
    Steps(Desk& desk, ClothShelf& shelf) : m_desk(&desk), m_shelf(&shelf) {}

    /// Validates for these looms (none named: for all of the site) and hands it to the approvers.
    Result<Json> submit(const Caller& caller, const Ask& ask, const StepWish& wish,
                        const std::vector<std::string>& looms);
    /// `reason` is the text. Pick and end count from 1.
    Result<Json> comment(const Caller& caller, const Ask& ask, const StepWish& wish,
                         std::optional<std::int64_t> pick, std::optional<std::int64_t> end);
    Result<Json> request_changes(const Caller& caller, const Ask& ask, const StepWish& wish);
    Result<Json> waive(const Caller& caller, const Ask& ask, const StepWish& wish, const std::string& rule,
                       const std::string& loom);
    /// Refused while evidence is missing, with what is missing. The last approval that the policy asks for
    /// makes the revision approved.
    Result<Json> approve(const Caller& caller, const Ask& ask, const StepWish& wish);

  private:
    Result<FoundRevision> found(const Caller& caller, Action action, const StepWish& wish);
    Result<std::vector<Validation>> validate_for(const FoundRevision& here,
                                                 const std::vector<std::string>& looms);
    Status renew_validations(const FoundRevision& here);

    Desk* m_desk;
    ClothShelf* m_shelf;
};

/// Records what a validation found, as the server's own statement.
Status log_validation(Writer& writer, const Desk& desk, const std::string& request,
                      const FoundRevision& found, const Validation& validation);

}  // namespace weave::loomlink
