#include <loomlink/audit/told_keys.hpp>

#include <loomlink/audit/bundle_layout.hpp>
#include <loomlink/audit/record.hpp>

namespace weave::loomlink {

namespace {

bool hands_out_a_key(const Statement& statement) {
    return (statement.kind == "person.joined" || statement.kind == "signer.enrolled") && statement.subject;
}

std::string text_of(const Json& data, const char* member) {
    return data.contains(member) && data.at(member).is_string() ? data.at(member).get<std::string>() : "";
}

}  // namespace

ToldPublicKeys told_keys(std::string_view bundle) {
    ToldPublicKeys keys;
    for (std::string_view line : bundle::split(bundle).records) {
        if (line.ends_with(',')) line.remove_suffix(1);
        const auto record = parse_record(line);
        if (!record || !hands_out_a_key(record->statement)) continue;
        const Json& data = record->statement.data;
        const auto key = parse_public_key(text_of(data, "public_key"));
        if (key && key_id(*key) == text_of(data, "key"))
            keys.try_emplace(key_id(*key), ToldPublicKey{*key, *record->statement.subject});
    }
    return keys;
}

}  // namespace weave::loomlink
