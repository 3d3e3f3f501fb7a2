#include <weave/sql/database.hpp>

#include <weave/sql/postgres.hpp>
#include <weave/sql/sqlite.hpp>

namespace weave::sql {

namespace {

std::string in_hex(std::string_view bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        text += digits[byte >> 4];
        text += digits[byte & 15];
    }
    return text;
}

}  // namespace

std::int64_t Row::integer(int column) const {
    const Value found = value(column);
    const auto* const number = std::get_if<std::int64_t>(&found);
    return number == nullptr ? 0 : *number;
}

double Row::real(int column) const {
    const Value found = value(column);
    const auto* const number = std::get_if<double>(&found);
    return number == nullptr ? static_cast<double>(integer(column)) : *number;
}

std::string_view Row::view(int column) const {
    const Value found = value(column);
    if (const auto* const text = std::get_if<std::string_view>(&found)) return *text;
    const auto* const blob = std::get_if<Blob>(&found);
    return blob == nullptr ? std::string_view() : blob->bytes;
}

Json Row::json(int column) const {
    const Value found = value(column);
    if (const auto* const number = std::get_if<std::int64_t>(&found)) return *number;
    if (const auto* const number = std::get_if<double>(&found)) return *number;
    if (std::holds_alternative<std::monostate>(found)) return nullptr;
    return std::holds_alternative<Blob>(found) ? in_hex(view(column)) : bytes(column);
}

Engine engine_of(std::string_view place) {
    return place.starts_with("postgresql://") || place.starts_with("postgres://") ? Engine::postgres : Engine::sqlite;
}

Result<std::unique_ptr<Connection>> Connection::open(const std::string& place, Access access,
                                                     std::chrono::milliseconds patience) {
    if (engine_of(place) == Engine::postgres) return open_postgres(place, access, patience);
    WEAVE_TRY(std::unique_ptr<Connection> opened, SqliteConnection::open_file(place, access, patience));
    return opened;
}

}  // namespace weave::sql
