#pragma once

#include <loomlink/workflow/desk.hpp>
#include <loomlink/workflow/found.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// Looms: their profiles, operators, and what operators tell.
class LoomDesk {
  public:
    explicit LoomDesk(Desk& desk) : m_desk(&desk) {}

    /// `profile` is the text of a profile (PROFILE.md), read as a stranger's.
    Result<Json> add(const Caller& caller, const Ask& ask, const std::string& name,
                     const std::string& profile);
    /// Puts a new version in force. What was released for the one before is superseded, what waits for
    /// signatures withdrawn: it has to be released again.
    Result<Json> set_profile(const Caller& caller, const Ask& ask, const std::string& loom,
                             const std::string& profile);
    Result<Json> set_operators(const Caller& caller, const Ask& ask, const std::string& loom,
                               const std::vector<std::string>& names);

    /// `looms` that the caller may see: `name`, `profile_name`, `released`, `loaded`.
    Result<Json> list(const Caller& caller);
    /// One loom with releases, faults, profile and operators.
    Result<Json> read(const Caller& caller, const std::string& loom);

    /// The last woven pick, from 1.
    Result<Json> keep_place(const Caller& caller, const Ask& ask, const std::string& loom,
                            std::int64_t release, std::int64_t pick);
    Result<Json> confirm_loaded(const Caller& caller, const Ask& ask, const std::string& loom,
                                std::int64_t release);
    Result<Json> report_fault(const Caller& caller, const Ask& ask, const std::string& loom,
                              std::int64_t release, const std::string& text, std::optional<std::int64_t> pick,
                              std::optional<std::int64_t> end);

  private:
    Desk* m_desk;
};

/// The design that a release is of.
Result<FoundRevision> revision_of(const Reader& reader, const Release& release);

}  // namespace weave::loomlink
