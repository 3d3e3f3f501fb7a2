#include <weave/core/json_reader.hpp>

#include <loomlink/keys/members.hpp>
#include <loomlink/keys/tree_head.hpp>

namespace weave::loomlink {

Json tree_head_body(const TreeHead& head) {
    return {{"site", head.site}, {"size", head.size}, {"root", head.root}, {"at", utc_text(head.at)}};
}

Result<TreeHead> open_tree_head(const SignedDocument& document, const TrustDocument& trust) {
    constexpr std::size_t root_characters = 64;
    WEAVE_CHECK_OK(check_signatures(document, Purpose::tree_head, trust, Role::log, 1));
    JsonReader reader(document.body, "body");
    TreeHead head;
    head.site = name_member(reader, "site");
    head.size = count_member(reader, "size");
    head.root = hex_member(reader, "root", root_characters);
    head.at = utc_member(reader, "at");
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    if (head.site != trust.site)
        return Error{ErrorCode::refused, "is the head of the log of '" + head.site + "', not of '" + trust.site + "'",
                     "body.site"};
    return head;
}

}  // namespace weave::loomlink
