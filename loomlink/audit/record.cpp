#include <loomlink/audit/record.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/keys/hex.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace weave::loomlink {

namespace {

constexpr std::size_t longest_name = 200;
constexpr std::size_t longest_kind = 64;
constexpr std::size_t longest_reason = 8000;
constexpr std::int64_t largest_seq = std::int64_t{1} << 53;  // JSON keeps whole numbers up to here

Json statement_json(const Statement& statement) {
    Json json = {{"site", statement.site},   {"kind", statement.kind},       {"at", statement.at},
                 {"actor", statement.actor}, {"request", statement.request}, {"data", statement.data}};
    if (statement.subject) json["subject"] = *statement.subject;
    if (statement.reason) json["reason"] = *statement.reason;
    return json;
}

bool is_kind(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    });
}

std::string required_text(JsonReader& reader, const std::string& key, std::size_t longest) {
    std::string text = reader.text(key, {}, longest);
    if (text.empty()) reader.fail("must not be empty", key);
    return text;
}

std::optional<std::string> optional_text(JsonReader& reader, const std::string& key, std::size_t longest) {
    if (!reader.has(key)) return {};
    return required_text(reader, key, longest);
}

Statement read_statement(JsonReader reader) {
    Statement statement;
    statement.site = required_text(reader, "site", longest_name);
    statement.kind = required_text(reader, "kind", longest_kind);
    if (!is_kind(statement.kind)) reader.fail("must be of a to z, digits, '.', '_' and '-'", "kind");
    statement.at = required_text(reader, "at", longest_name);
    if (!is_utc_moment(statement.at)) reader.fail("must be a moment such as 2026-11-26T09:30:00.000Z", "at");
    statement.actor = required_text(reader, "actor", longest_name);
    statement.subject = optional_text(reader, "subject", longest_name);
    statement.reason = optional_text(reader, "reason", longest_reason);
    statement.request = required_text(reader, "request", longest_name);
    statement.data = reader.object("data").json();
    reader.no_others();
    return statement;
}

/// Numbers that JSON cannot say would otherwise end in an assertion of the writer.
bool all_finite(const Json& value) {
    if (value.is_number_float()) return std::isfinite(value.get<double>());
    return !value.is_structured() || std::all_of(value.begin(), value.end(), all_finite);
}

/// The number that two digits or more say; -1 for what is none.
int digits(std::string_view text, std::size_t from, std::size_t count) {
    int number = 0;
    for (const char c : text.substr(from, count)) {
        if (c < '0' || c > '9') return -1;
        number = number * 10 + (c - '0');
    }
    return number;
}

}  // namespace

bool is_utc_moment(std::string_view text) {
    constexpr std::string_view form = "0000-00-00T00:00:00.000Z";
    if (text.size() != form.size()) return false;
    for (std::size_t k = 0; k < form.size(); ++k) {
        if (form[k] != '0' && text[k] != form[k]) return false;
        if (form[k] == '0' && (text[k] < '0' || text[k] > '9')) return false;
    }
    using namespace std::chrono;
    const year_month_day day{year(digits(text, 0, 4)), month(static_cast<unsigned>(digits(text, 5, 2))),
                             std::chrono::day(static_cast<unsigned>(digits(text, 8, 2)))};
    return day.ok() && day.year() >= year(1970) && digits(text, 11, 2) < 24 && digits(text, 14, 2) < 60 &&
           digits(text, 17, 2) < 60;
}

Json signature_json(const RecordSignature& signature) {
    return {{"key", signature.key}, {"value", signature.value}};
}

Result<RecordSignature> signature_from(const Json& json, const std::string& where) {
    JsonReader reader(json, where);
    RecordSignature signature;
    signature.key = reader.text("key");
    if (!is_hex(signature.key, 64)) reader.fail("must be 64 lower-case hexadecimal characters", "key");
    signature.value = reader.text("value");
    if (!is_hex(signature.value, 128))
        reader.fail("must be 128 lower-case hexadecimal characters", "value");
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return signature;
}

std::string statement_bytes(const Statement& statement) {
    return canonical_json(statement_json(statement));
}

Result<std::string> record_bytes(const EventRecord& record) {
    if (!all_finite(record.statement.data))
        return bad_input("holds a number that is not finite", "statement.data");
    Json json = {{"seq", record.seq},
                 {"prev", hash_hex(record.prev)},
                 {"statement", statement_json(record.statement)}};
    if (record.signature) json["signature"] = signature_json(*record.signature);
    std::string bytes = canonical_json(json);
    WEAVE_CHECK_OK(parse_record(bytes));
    return bytes;
}

Result<EventRecord> parse_record(std::string_view bytes) {
    if (bytes.size() > longest_record)
        return bad_input("is longer than " + std::to_string(longest_record) + " bytes");
    WEAVE_TRY(const Json json, parse_json(bytes));
    JsonReader reader(json, "");
    EventRecord record;
    record.seq = static_cast<std::uint64_t>(reader.integer("seq", 0, largest_seq));
    const auto prev = parse_hash(reader.text("prev"));
    if (prev)
        record.prev = *prev;
    else
        reader.fail("must be 64 lower-case hexadecimal characters", "prev");
    record.statement = read_statement(reader.object("statement"));
    const bool is_signed = reader.has("signature");
    const Json signature = is_signed ? reader.raw("signature") : Json();
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    if (is_signed) {
        WEAVE_TRY(record.signature, signature_from(signature, "signature"));
    }
    if (canonical_json(json) != bytes) return bad_input("is not in canonical form");
    return record;
}

}  // namespace weave::loomlink
