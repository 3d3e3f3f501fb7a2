#include <loomlink/audit/head.hpp>

#include <weave/core/json_reader.hpp>

namespace weave::loomlink {

namespace {

constexpr std::int64_t largest_size = std::int64_t{1} << 53;  // JSON keeps whole numbers up to here

Json head_json(const TreeHead& head) {
    return {{"site", head.site}, {"size", head.size}, {"root", hash_hex(head.root)}, {"at", head.at}};
}

TreeHead read_head(JsonReader reader) {
    TreeHead head;
    head.site = reader.text("site", {}, 200);
    if (head.site.empty()) reader.fail("must not be empty", "site");
    head.size = static_cast<std::uint64_t>(reader.integer("size", 1, largest_size));
    if (const auto root = parse_hash(reader.text("root")))
        head.root = *root;
    else
        reader.fail("must be 64 lower-case hexadecimal characters", "root");
    head.at = reader.text("at");
    if (!is_utc_moment(head.at)) reader.fail("must be a moment such as 2026-11-26T09:30:00.000Z", "at");
    reader.no_others();
    return head;
}

}  // namespace

std::string head_bytes(const TreeHead& head) {
    return canonical_json(head_json(head));
}

std::string signed_head_bytes(const SignedTreeHead& head) {
    return canonical_json({{"head", head_json(head.head)}, {"signature", signature_json(head.signature)}});
}

Result<SignedTreeHead> parse_signed_head(std::string_view bytes) {
    WEAVE_TRY(const Json json, parse_json(bytes));
    JsonReader reader(json, "");
    SignedTreeHead head;
    head.head = read_head(reader.object("head"));
    const Json signature = reader.raw("signature");
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    WEAVE_TRY(head.signature, signature_from(signature, "signature"));
    if (canonical_json(json) != bytes) return bad_input("is not in canonical form");
    return head;
}

}  // namespace weave::loomlink
