#include <weave/sql/database.hpp>

#include <loomlink/store/chunks.hpp>
#include <loomlink/store/reader.hpp>
#include <loomlink/store/unpack.hpp>
#include <loomlink/store/writer.hpp>
#include <zstd.h>

namespace weave::loomlink {

namespace {

constexpr int zstd_level = 3;

/// Compressed bytes, or nothing where that does not help.
std::optional<std::string> pack(std::string_view bytes) {
    std::string packed(ZSTD_compressBound(bytes.size()), '\0');
    const std::size_t size =
        ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), zstd_level);
    if (ZSTD_isError(size) != 0 || size >= bytes.size()) return {};
    packed.resize(size);
    return packed;
}

Result<Id> put_chunk(sql::Connection& connection, std::string_view bytes) {
    const Hash hash = sha256(bytes);
    WEAVE_TRY(const Id known, connection.number("SELECT id FROM chunk WHERE hash = ?", hash));
    if (known != 0) return known;
    const auto packed = pack(bytes);
    return connection.number("INSERT INTO chunk (hash, size, packed, bytes) VALUES (?, ?, ?, ?) RETURNING id", hash,
                             static_cast<std::int64_t>(bytes.size()), std::int64_t{packed ? 1 : 0},
                             sql::Blob{packed ? std::string_view(*packed) : bytes});
}

}  // namespace

std::optional<std::string> unpack_chunk(const std::string& bytes, bool packed, std::int64_t size) {
    if (size < 0 || size > static_cast<std::int64_t>(most_chunk)) return {};
    if (!packed) return bytes.size() == static_cast<std::size_t>(size) ? std::optional(bytes) : std::nullopt;
    std::string plain(static_cast<std::size_t>(size), '\0');
    const std::size_t got = ZSTD_decompress(plain.data(), plain.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(got) != 0 || got != plain.size()) return {};
    return plain;
}

Result<bool> Reader::has_object(const Hash& hash) const {
    WEAVE_TRY(const std::int64_t count,
              connection().number("SELECT count(*) FROM object WHERE hash = ?", hash));
    return count > 0;
}

Reader::Maybe<std::string> Reader::object(const Hash& hash) const {
    WEAVE_TRY(const bool known, has_object(hash));
    if (!known) return std::optional<std::string>();
    std::string bytes;
    bool whole = true;
    WEAVE_CHECK_OK(connection().each(
        "SELECT c.bytes, c.packed, c.size FROM object o JOIN object_chunk p ON p.object = o.id "
        "JOIN chunk c ON c.id = p.chunk WHERE o.hash = ? ORDER BY p.position",
        [&](const sql::Row& row) {
            const auto plain = unpack_chunk(row.bytes(0), row.integer(1) != 0, row.integer(2));
            whole = whole && plain;
            if (whole) bytes += *plain;
        },
        hash));
    if (!whole || sha256(bytes) != hash)
        return system_fault("the store is damaged: object " + hash_hex(hash) +
                            " is not what it was; restore a backup");
    return std::optional(std::move(bytes));
}

Result<Hash> Writer::put_object(std::string_view bytes) {
    if (bytes.size() > largest_object)
        return bad_input("is larger than " + std::to_string(largest_object >> 20) + " MiB");
    const Hash hash = sha256(bytes);
    WEAVE_TRY(const bool known, has_object(hash));
    if (known) return hash;
    WEAVE_TRY(const Id object, connection().number("INSERT INTO object (hash, size) VALUES (?, ?) RETURNING id", hash,
                                                   static_cast<std::int64_t>(bytes.size())));
    std::int64_t position = 0;
    for (const std::string_view chunk : cut_into_chunks(bytes)) {
        WEAVE_TRY(const Id id, put_chunk(connection(), chunk));
        WEAVE_CHECK_OK(connection().run("INSERT INTO object_chunk (object, position, chunk) VALUES (?, ?, ?)",
                                        object, position++, id));
    }
    return hash;
}

Result<Id> Writer::object_id(const Hash& hash) {
    WEAVE_TRY(const Id id, connection().number("SELECT id FROM object WHERE hash = ?", hash));
    if (id == 0) return Error{ErrorCode::refused, "there is no object " + hash_hex(hash), {}};
    return id;
}

}  // namespace weave::loomlink
