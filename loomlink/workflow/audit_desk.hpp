#pragma once

#include <loomlink/workflow/desk.hpp>
#include <optional>
#include <string>

namespace weave::loomlink {

/// The log, to be read and proved. For engineers.
class AuditDesk {
  public:
    explicit AuditDesk(Desk& desk) : m_desk(&desk) {}

    /// `events`, oldest first, from a number on, at most 1,000; of one design where it is named. Each has
    /// `record`, the canonical text that the tree is made of.
    Result<Json> events(const Caller& caller, Seq from, std::size_t limit,
                        const std::optional<std::string>& design);
    /// `site`, `size`, `root`, `at`, `signature`.
    Result<Json> head(const Caller& caller);
    /// `path` of the record in the tree of so many records.
    Result<Json> inclusion(const Caller& caller, Seq seq, std::uint64_t size);
    /// `path` that shows that the log only grew.
    Result<Json> consistency(const Caller& caller, std::uint64_t from, std::uint64_t size);
    /// The whole log as a file to verify offline. Taking it is logged.
    Result<std::string> bundle(const Caller& caller);

  private:
    Desk* m_desk;
};

}  // namespace weave::loomlink
