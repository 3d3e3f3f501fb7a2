#include <loomlink/commands/log_words.hpp>

#include <weave/core/text.hpp>
#include <weave/keys/hex.hpp>

#include <algorithm>
#include <loomlink/commands/words.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t shown_of_hash = 16;

/// Those that a person looks for come first, whatever a record has besides.
const std::vector<std::string> first_members{"revision", "loom", "release", "file", "roles"};

/// Those that only programs compare: they tell a person nothing, and stand in the JSON.
const std::vector<std::string> left_out{"code_sha256", "password_sha256", "public_key"};

bool is_in(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.' || c == ':';
}

std::string text_shown(const std::string& text) {
    constexpr std::size_t hash = 64, signature = 128;
    if (is_hex(text, hash) || is_hex(text, signature)) return text.substr(0, shown_of_hash);
    if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return text;
    return on_one_line(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
}

/// A number, a text or a list of them; empty where it has parts.
std::string value_shown(const Json& value) {
    if (value.is_string()) return text_shown(value.get_ref<const std::string&>());
    if (value.is_number() || value.is_boolean()) return value.dump();
    if (!value.is_array()) return "";
    if (value.empty()) return "none";
    std::string all;
    for (const Json& entry : value) {
        if (entry.is_structured()) return "";
        all += (all.empty() ? "" : " ") + value_shown(entry);
    }
    return all;
}

void add_member(std::string& words, const std::string& name, const Json& value) {
    const std::string shown = value_shown(value);
    if (shown.empty()) return;
    std::string spaced = on_one_line(name);
    std::replace(spaced.begin(), spaced.end(), '_', ' ');
    words += (words.empty() ? "" : ", ") + spaced + " " + shown;
}

std::string data_shown(const Json& record) {
    std::string words;
    if (!record.contains("data") || !record.at("data").is_object()) return words;
    const Json& data = record.at("data");
    for (const std::string& name : first_members)
        if (data.contains(name)) add_member(words, name, data.at(name));
    for (const auto& [name, value] : data.items())
        if (!is_in(first_members, name) && !is_in(left_out, name)) add_member(words, name, value);
    return words;
}

/// The key that signed the record, which stands in its own bytes; empty where nobody signed.
std::string signing_key(const Json& record) {
    if (!record.contains("record") || !record.at("record").is_string()) return "";
    const auto bytes = parse_json(record.at("record").get_ref<const std::string&>());
    if (!bytes || !bytes->is_object() || !bytes->contains("signature")) return "";
    return told(bytes->at("signature"), "key").substr(0, shown_of_hash);
}

}  // namespace

std::vector<std::string> log_cells(const Json& record) {
    std::string rest = data_shown(record);
    const auto add = [&rest](const std::string& part) { rest += (rest.empty() ? "" : "; ") + part; };
    const auto shown = [&record](const char* member) {
        return record.contains(member) ? value_shown(record.at(member)) : std::string();
    };
    if (const std::string reason = shown("reason"); !reason.empty()) add("because " + reason);
    if (const std::string signer = shown("signed"); !signer.empty()) {
        const std::string key = signing_key(record);
        add("signed by " + signer + (key.empty() ? "" : ", key " + key));
    }
    return {told(record, "seq"),  told(record, "at"),      told(record, "actor"),
            told(record, "kind"), told(record, "subject"), std::move(rest)};
}

}  // namespace weave::loomlink
