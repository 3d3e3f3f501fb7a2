#include <loomlink/keys/log_head.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/keys/members.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t root_characters = 64, key_characters = 64, value_characters = 128;

Json head_body(const LogHead& head) {
    return {{"site", head.site}, {"size", head.size}, {"root", head.root}, {"at", utc_text(head.at)}};
}

}  // namespace

SignedLogHead sign_head(const KeyPair& log_key, const LogHead& head) {
    return {head, sign_body(log_key, Purpose::tree_head, head_body(head))};
}

Json to_json(const SignedLogHead& signed_head) {
    return {{"head", head_body(signed_head.head)},
            {"signature", {{"key", signed_head.signature.key}, {"value", signed_head.signature.value}}}};
}

Result<SignedLogHead> head_from_json(const Json& json) {
    JsonReader reader(json, "");
    SignedLogHead read;
    JsonReader head = reader.object("head");
    read.head.site = name_member(head, "site");
    read.head.size = count_member(head, "size", 1);
    read.head.root = hex_member(head, "root", root_characters);
    read.head.at = utc_member(head, "at");
    head.no_others();
    JsonReader signature = reader.object("signature");
    read.signature = {hex_member(signature, "key", key_characters),
                      hex_member(signature, "value", value_characters)};
    signature.no_others();
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return read;
}

Status check_head(const SignedLogHead& signed_head, const TrustDocument& trust) {
    const LogHead& head = signed_head.head;
    WEAVE_CHECK_OK(check_signatures({head_body(head), {signed_head.signature}}, Purpose::tree_head, trust,
                                    Role::log, 1));
    if (head.site != trust.site)
        return Error{ErrorCode::refused,
                     "is the head of the log of '" + head.site + "', not of '" + trust.site + "'",
                     "head.site"};
    return {};
}

}  // namespace weave::loomlink
