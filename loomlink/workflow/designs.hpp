#pragma once

#include <loomlink/workflow/cloths.hpp>
#include <loomlink/workflow/desk.hpp>
#include <loomlink/workflow/found.hpp>
#include <optional>
#include <string>
#include <vector>

namespace weave::loomlink {

/// A revision that somebody wants to save.
struct SaveWish {
    std::string design, branch, message;
    std::string document;  ///< the text of a `.weave` file
    std::optional<std::int64_t>
        expected;                    ///< the branch's head that it was made from; none: the branch is new
    std::vector<std::int64_t> also;  ///< further parents: of a merge, or where a new branch begins
};

/// Designs and their revisions, to read and to save. Numbers of picks and ends in answers count from 1.
class DesignDesk {
  public:
    DesignDesk(Desk& desk, ClothShelf& shelf) : m_desk(&desk), m_shelf(&shelf) {}

    Result<Json> add(const Caller& caller, const Ask& ask, const std::string& name);
    /// Reads and weaves the document as one from a stranger, then keeps it: `number`, `sha256`. Refused as a
    /// conflict where the branch has moved on.
    Result<Json> save(const Caller& caller, const Ask& ask, const SaveWish& wish);

    /// `designs`: of each `name` and `newest`.
    Result<Json> list(const Caller& caller);
    /// `name`, `branches`, `revisions` (newest first), `releases`.
    Result<Json> graph(const Caller& caller, const std::string& design);
    /// Everything about a revision, what is missing and what this person may do. The look is logged.
    Result<Json> revision(const Caller& caller, const std::string& design, std::int64_t number);
    Result<std::string> document(const Caller& caller, const std::string& design, std::int64_t number);
    /// PNG; `view` is card, face, back, floats or layers.
    Result<std::string> picture(const Caller& caller, const std::string& design, std::int64_t number,
                                const std::string& view);
    Result<std::string> card(const Caller& caller, const std::string& design, std::int64_t number,
                             const CardTile& tile);
    Result<Json> check(const Caller& caller, const std::string& design, std::int64_t number,
                       const std::string& loom);
    /// As `weave diff --json`, with `summary` in words.
    Result<Json> diff(const Caller& caller, const std::string& design, std::int64_t from, std::int64_t to);
    Result<std::string> diff_picture(const Caller& caller, const std::string& design, std::int64_t from,
                                     std::int64_t to);

  private:
    Result<FoundRevision> found(const Caller& caller, const std::string& design, std::int64_t number);
    Result<RevisionClothPtr> cloth(const Caller& caller, const std::string& design, std::int64_t number);

    Desk* m_desk;
    ClothShelf* m_shelf;
};

/// What the answer about a revision says, for this caller.
Result<Json> revision_json(const Reader& reader, const Caller& caller, const FoundRevision& found,
                           const weave::Design& design);

}  // namespace weave::loomlink
