#pragma once

#include <cstdint>
#include <loomlink/store/reader.hpp>
#include <loomlink/workflow/caller.hpp>
#include <loomlink/workflow/denial.hpp>
#include <optional>
#include <string>

namespace weave::loomlink {

/// Things by their names, for this caller: absent where they are not, or not open to him or her.
struct FoundRevision {
    Design design;
    Revision revision;
};
Status need_designs_open(const Caller& caller);
Result<Design> find_design(const Reader& reader, const Caller& caller, const std::string& design);
Result<FoundRevision> find_revision(const Reader& reader, const Caller& caller, const std::string& design,
                                    std::int64_t number);

/// Whether a pick and an end, from 1, are on the card of a revision. Errors name the one that is not.
Status check_on_card(const Revision& revision, std::optional<std::int64_t> pick, std::optional<std::int64_t> end);

/// A loom that the caller may see: readers all, operators those that name them, admins all.
Result<Loom> find_loom(const Reader& reader, const Caller& caller, const std::string& loom);
/// A loom of which the caller is an operator.
Result<Loom> find_own_loom(const Reader& reader, const Caller& caller, const std::string& loom);
/// A release whose files this person may have: of a loom that he or she may see, but not as admin alone.
struct FoundRelease {
    Loom loom;
    Release release;
};
Result<FoundRelease> find_release(const Reader& reader, const Caller& caller, const std::string& loom,
                                  std::int64_t number);

/// The full name of a person.
Result<std::string> full_name_of(const Reader& reader, Id person);

}  // namespace weave::loomlink
