#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>
#include <weave/keys/hash.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace weave::loomlink {

/// A signature over bytes, opaque here: who made it and what it is are for the key's owner to say.
struct RecordSignature {
    std::string key;    ///< the key's name, 64 lower-case hexadecimal characters
    std::string value;  ///< 64 bytes as 128 lower-case hexadecimal characters
    friend bool operator==(const RecordSignature&, const RecordSignature&) = default;
};

/// Whether the signature is good over these bytes by a key that counts.
using SignatureCheck = std::function<bool(std::string_view bytes, const RecordSignature&)>;

/// What happened, by whom, when and why: the part of a record that a person signs.
struct Statement {
    std::string site;   ///< name of the installation, so that no statement passes for another's
    std::string kind;   ///< such as `revision.approved`: a to z, digits, `.`, `_`, `-`
    std::string at;     ///< UTC, `2026-11-26T09:30:00.000Z`
    std::string actor;  ///< login name, or what acted by itself
    std::optional<std::string> subject;  ///< what it was done to
    std::optional<std::string> reason;
    std::string request;  ///< the unique id of the request that led to it
    Json data = Json::object();
    friend bool operator==(const Statement&, const Statement&) = default;
};

/// One record of the log.
struct EventRecord {
    std::uint64_t seq = 0;  ///< from 0 without gaps; the number of its leaf in the tree
    Hash prev{};            ///< leaf hash of the record before; zeros for the first
    Statement statement;
    std::optional<RecordSignature> signature;  ///< over statement_bytes()
    friend bool operator==(const EventRecord&, const EventRecord&) = default;
};

/// No record is longer.
inline constexpr std::size_t longest_record = std::size_t{1} << 20;

/// The canonical JSON of a statement: what is signed.
std::string statement_bytes(const Statement& statement);

/// The canonical JSON of a record: what is stored, hashed and exported. Refused as parse_record() would
/// refuse it, so nothing is written that cannot be read.
Result<std::string> record_bytes(const EventRecord& record);

/// Reads a record. Refused, with the place: anything but the canonical bytes of a record of known members.
Result<EventRecord> parse_record(std::string_view bytes);

/// Whether `text` is a moment that exists, as `2026-11-26T09:30:00.000Z`; years 1970 to 9999.
bool is_utc_moment(std::string_view text);

/// `{"key":…,"value":…}` and back.
Json signature_json(const RecordSignature& signature);
Result<RecordSignature> signature_from(const Json& json, const std::string& where);

}  // namespace weave::loomlink
