#pragma once

#include "store_case.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace weave::loomlink::testing {

inline const TestKey& log_key() {
    static const TestKey key(1);
    return key;
}
inline const TestKey& person_key() {
    static const TestKey key(2);
    return key;
}

inline SignedTreeHead sign_log(Store& store) {
    return store
        .write([](Writer& writer) -> Result<SignedTreeHead> {
            WEAVE_TRY(const std::uint64_t size, writer.log_size());
            WEAVE_TRY(const Hash root, writer.root(size));
            const TreeHead plain{"mill", size, root, "2026-11-26T10:00:00.000Z"};
            const SignedTreeHead head{plain, log_key().sign(head_bytes(plain))};
            WEAVE_CHECK_OK(writer.add_head(head));
            return head;
        })
        .value();
}

/// A closed store of 40 records, each with an object, and its last head. A copy was kept every five records,
/// each with the head of its time.
struct Original {
    static constexpr std::uint64_t size = 40;
    Folder folder;
    std::filesystem::path path = folder / "store.db";
    std::map<std::uint64_t, std::filesystem::path> older;
    std::map<std::uint64_t, SignedTreeHead> older_heads;
    StoreTrust trust{log_key().check(), person_key().check(), {}};

    Original() {
        Store store = Store::create(path, "mill").value();
        for (std::uint64_t k = 0; k < size; ++k) {
            const Status status = store.write([&](Writer& writer) -> Status {
                const Statement statement = statement_of(k);
                WEAVE_CHECK_OK(writer.put_object(object(k)));
                WEAVE_CHECK_OK(writer.append(statement, person_key().sign(statement_bytes(statement))));
                return {};
            });
            REQUIRE(status);
            if (k % 5 == 4 && k + 1 < size) keep_copy(store, k + 1);
        }
        trust.retained = sign_log(store);
    }
    /// The bytes of object k, whose row is k + 1. The first is cut into several chunks.
    static std::string object(std::uint64_t k) {
        if (k > 0) return "object " + std::to_string(k);
        std::string bytes(200'000, '\0');
        std::uint32_t state = 1;
        for (char& c : bytes) c = static_cast<char>((state = state * 1664525U + 1013904223U) >> 24);
        return bytes;
    }

  private:
    void keep_copy(Store& store, std::uint64_t records) {
        older_heads[records] = sign_log(store);
        older[records] = folder / ("older-" + std::to_string(records) + ".db");
        REQUIRE(back_up_store(path.string(), older[records]));
    }
};

/// Puts a copy into the place of the one before.
inline void copy_over(const std::filesystem::path& from, const std::filesystem::path& to) {
    for (const char* more : {"-wal", "-shm"}) std::filesystem::remove(to.string() + more);
    std::filesystem::copy_file(from, to, std::filesystem::copy_options::overwrite_existing);
}

}  // namespace weave::loomlink::testing
