#pragma once

#include <weave/diff/change.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace weave {

/// What a member of a document is called for people, and its unit.
struct MemberWords {
    std::string name, unit;
};
/// Of a member's key, such as `radius_mm`. A key without words of its own is called by itself.
MemberWords words_of_member(const std::string& key);

/// Tells every member in which two objects differ, objects within them included; `subject` goes in front of
/// each line, such as `warp yarn 2 'red'`.
void diff_members(const Json& before, const Json& after, const std::string& where, const std::string& subject,
                  Changes& changes);

/// How the entries of a list are told apart.
struct ListWords {
    std::string noun;       ///< of one entry: `warp yarn`
    bool has_names = true;  ///< entries have a `name` by which they can be known again
    bool by_place = true;   ///< entries left over at the same place are the same one, changed
};

/// Which entry after is which before: by equal content, then by name, then by place.
class ListPartners {
  public:
    ListPartners(const Json& before, const Json& after, const ListWords& words);

    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    /// The entry after that was this one, or `none`.
    [[nodiscard]] std::size_t of_before(std::size_t k) const { return m_of_before[k]; }
    [[nodiscard]] std::size_t of_after(std::size_t k) const { return m_of_after[k]; }
    [[nodiscard]] std::size_t before() const { return m_of_before.size(); }
    [[nodiscard]] std::size_t after() const { return m_of_after.size(); }

    /// A number that is equal on both sides exactly for partners.
    [[nodiscard]] std::size_t id_before(std::size_t k) const {
        return m_of_before[k] == none ? after() + k : m_of_before[k];
    }

  private:
    void join(std::size_t before, std::size_t after);
    /// Joins entries that are still free and have the same key, in their order.
    template <class Key>
    void join_by(const Json& before, const Json& after, Key key);

    std::vector<std::size_t> m_of_before, m_of_after;
};

/// `warp yarn 2 'red'` of an entry.
std::string entry_in_words(const Json& list, std::size_t k, const ListWords& words);

/// Tells what was added to a list, removed from it and changed in it, and whether what stayed stands in
/// another order.
void diff_list(const Json& before, const Json& after, const ListPartners& partners, const std::string& where,
               const ListWords& words, Changes& changes);

}  // namespace weave
