#include "store_places.hpp"

#include <regex>

namespace weave::loomlink::testing {

std::string for_server(const std::string& sql) {
    static const std::regex blob("x'([0-9a-fA-F]*)'"), drop("DROP TRIGGER \\w+;"), drop_last("DROP TRIGGER (\\w+)$"), to_bytes("CAST\\((.*) AS BLOB\\)"), to_text("CAST\\((\\w+) AS TEXT\\)"), zeros("zeroblob\\((\\d+)\\)"),
        random("randomblob\\(32\\)"), version("PRAGMA user_version = (\\d+)"), any("CREATE TABLE t \\(x\\)");
    std::string words = std::regex_replace(sql, blob, "decode('$1', 'hex')");
    words = std::regex_replace(words, drop, "");
    words = std::regex_replace(words, drop_last, "DROP FUNCTION $1 CASCADE");
    words = std::regex_replace(words, to_bytes, "convert_to($1, 'UTF8')");
    words = std::regex_replace(words, to_text, "convert_from($1, 'UTF8')");
    words = std::regex_replace(words, zeros, "decode(repeat('00', $1), 'hex')");
    words = std::regex_replace(words, random, "sha256(convert_to(clock_timestamp()::text, 'UTF8'))");
    words = std::regex_replace(words, version, "UPDATE store_version SET version = $1");
    return std::regex_replace(words, any, "CREATE TABLE t (x bigint)");
}

}  // namespace weave::loomlink::testing
