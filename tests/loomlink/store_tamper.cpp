// Tampering with the file of a store, by SQL without its rules, by whole older copies, and byte by byte.

#include "tamper_case.hpp"

#include <weave/core/file.hpp>

#include <set>
#include <support/random.hpp>

namespace weave::loomlink::testing {

using weave::testing::Random;

namespace {

std::string text_of(std::uint64_t number) {
    return std::to_string(number);
}

/// SQL that tampers with a store; the records of which one must be named, or words that must be said.
struct Attempt {
    std::string sql;
    std::set<Seq> touched{};
    std::string words{};
};

Attempt on_records(Random& random) {
    const std::size_t a = random.between(0, Original::size - 2),
                      b = random.between(a + 1, Original::size - 1);
    const std::string at = " WHERE seq = " + text_of(a);
    switch (random.between(0, 5)) {
        case 0:  // a bit of a byte, by a function that tamper_with() lends to SQL
            return {
                "UPDATE event SET record = flip(record, " + text_of(random.between(0, 100'000)) + ")" + at,
                {a}};
        case 1:
            return {"DELETE FROM event" + at, {a}};
        case 2:
            return {"UPDATE event SET seq = -1" + at + "; UPDATE event SET seq = " + text_of(a) +
                        " WHERE seq = " + text_of(b) + "; UPDATE event SET seq = " + text_of(b) +
                        " WHERE seq = -1",
                    {a, b}};
        case 3:
            return {"DELETE FROM event WHERE seq >= " + text_of(b), {b}};
        case 4:
            return {"UPDATE event SET actor = 'mallory'" + at, {a}};
        default:
            return {"UPDATE event SET leaf = randomblob(32)" + at, {a}};
    }
}

Attempt on_objects(Random& random) {
    const std::size_t a = random.between(1, Original::size - 2),
                      b = random.between(a + 1, Original::size - 1);
    const std::string row = text_of(a + 1), other = text_of(b + 1);
    const std::string name = "object " + hash_hex(sha256(Original::object(a)));
    switch (random.between(0, 8)) {
        case 0:
            return {
                "UPDATE chunk SET bytes = randomblob(length(bytes)) WHERE id = " + row, {}, "chunk " + row};
        case 1:
            return {"UPDATE chunk SET bytes = flip(bytes, " + text_of(random.between(0, 100'000)) +
                        ") WHERE id = " + row,
                    {},
                    "chunk " + row};
        case 2:
            return {"DELETE FROM chunk WHERE id = " + row, {}, "points at a row of chunk"};
        case 3:
            return {"DELETE FROM object WHERE id = " + row, {}, "points at a row of object"};
        case 4:
            return {"DELETE FROM object_chunk WHERE object = " + row, {}, name};
        case 5:
            return {"UPDATE object_chunk SET chunk = (SELECT chunk FROM object_chunk WHERE object = " +
                        other + ") WHERE object = " + row,
                    {},
                    name};
        case 6:
            return {"UPDATE object SET size = size + 1 WHERE id = " + row, {}, name};
        case 7:
            return {
                "UPDATE object SET hash = randomblob(32) WHERE id = " + row, {}, "is not what its hash says"};
        default:  // the first object's chunks in another order
            return {
                "UPDATE object_chunk SET position = 1000 - position WHERE object = 1; UPDATE object_chunk "
                "SET "
                "position = position - (SELECT min(position) FROM object_chunk WHERE object = 1) WHERE "
                "object = 1",
                {},
                "object " + hash_hex(sha256(Original::object(0)))};
    }
}

Attempt on_tree(Random& random) {
    const std::string head = text_of(random.between(1, Original::size / 5));
    switch (random.between(0, 3)) {
        case 0:
            return {"UPDATE tree_node SET hash = randomblob(32) WHERE level = 1 AND position = " +
                        text_of(random.between(0, Original::size / 2 - 1)),
                    {},
                    "tree above records"};
        case 1:
            return {
                "DELETE FROM tree_node WHERE level = " + text_of(random.between(1, 5)) + " AND position = 0",
                {},
                "tree above records"};
        case 2:
            return {"UPDATE tree_head SET head = flip(head, " + text_of(random.between(0, 100'000)) +
                        ") WHERE id = " + head,
                    {},
                    "head " + head};
        default:
            return {"UPDATE tree_head SET last_event = (last_event + 1) % " + text_of(Original::size) +
                        " WHERE id = " + head,
                    {},
                    "head " + head};
    }
}

std::string without_rules(const std::string& sql) {
    std::string drops = "PRAGMA ignore_check_constraints = ON; ";
    for (const char* table : {"event", "chunk", "object", "object_chunk", "tree_node", "tree_head"})
        for (const char* rule : {"_no_update", "_no_delete"})
            drops += "DROP TRIGGER " + std::string(table) + rule + "; ";
    return drops + sql;
}

/// An older copy, whole and with the good head of its time.
void replay(const Original& original, const std::filesystem::path& copy, Random& random) {
    const std::uint64_t records = 5 * random.between(1, Original::size / 5 - 1);
    copy_over(original.older.at(records), copy);
    const auto findings = verify_store(copy, original.trust).value();
    INFO("the copy of " << records << " records\n" << all_text(findings));
    REQUIRE(names_record(findings, records));
}

void tamper(std::size_t attempts) {
    const Original original;
    REQUIRE(all_text(verify_store(original.path, original.trust).value()).empty());
    const auto copy = original.folder / "copy.db";
    weave::testing::for_all(
        [&](Random& random) {
            const std::size_t way = random.between(0, 9);
            if (way == 9) return replay(original, copy, random);
            copy_over(original.path, copy);
            const Attempt attempt = way < 5   ? on_records(random)
                                    : way < 8 ? on_objects(random)
                                              : on_tree(random);
            tamper_with(copy, without_rules(attempt.sql));
            const auto findings = verify_store(copy, original.trust).value();
            INFO(attempt.sql << "\n" << all_text(findings));
            // the rules that had to be dropped are missed in any case; here the record itself counts
            bool named = !attempt.words.empty() && has_words(findings, attempt.words);
            for (const Seq seq : attempt.touched) named = named || names_record(findings, seq);
            REQUIRE(named);
        },
        attempts);
}

/// What a store says, without the numbers of rows that nothing names.
struct Content {
    std::map<Seq, std::string> records;
    std::string others;
    friend bool operator==(const Content&, const Content&) = default;
};

/// Takes each row of a query, its columns told apart; false where they cannot be read to the end.
template <class Take>
bool each_row(sqlite3* handle, const std::string& sql, Take take) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(handle, sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) return false;
    int code = SQLITE_ROW;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW) {
        std::string row;
        for (int k = 0; k < sqlite3_column_count(statement); ++k) {
            const int type = sqlite3_column_type(statement, k);
            const auto* bytes = static_cast<const char*>(sqlite3_column_blob(statement, k));
            row += std::to_string(type) + ':' + std::to_string(sqlite3_column_bytes(statement, k)) + ':';
            if (bytes != nullptr)
                row.append(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement, k)));
        }
        take(static_cast<Seq>(sqlite3_column_int64(statement, 0)), row);
    }
    sqlite3_finalize(statement);
    return code == SQLITE_DONE;
}

/// Nothing where the file is none of SQLite's any more, or cannot be read to its end.
std::optional<Content> content_of(const std::filesystem::path& path) {
    sqlite3* handle = nullptr;
    Content content;
    bool readable = sqlite3_open(path.c_str(), &handle) == SQLITE_OK;
    readable = readable && each_row(handle, "SELECT * FROM event",
                                    [&](Seq seq, const std::string& row) { content.records[seq] += row; });
    for (const char* sql :
         {"SELECT * FROM site", "SELECT * FROM transition", "SELECT * FROM tree_node",
          "SELECT last_event, head FROM tree_head", "SELECT * FROM chunk", "SELECT * FROM object",
          "SELECT * FROM object_chunk",
          "SELECT 0, type, name, sql FROM sqlite_schema WHERE sql IS NOT NULL ORDER BY type, name"})
        readable = readable &&
                   each_row(handle, sql, [&](Seq, const std::string& row) { content.others += row + '\n'; });
    sqlite3_close(handle);
    return readable ? std::optional(content) : std::nullopt;
}

std::set<Seq> changed_records(const Content& before, const Content& now) {
    std::set<Seq> seqs;
    for (const auto* one : {&before, &now})
        for (const auto& [seq, row] : one->records) {
            const auto& other = one == &before ? now.records : before.records;
            const auto found = other.find(seq);
            if (found == other.end() || found->second != row) seqs.insert(seq);
        }
    return seqs;
}

void flip_bit_at(std::string& bytes, std::size_t at, Random& random) {
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.between(0, 7)));
}

/// Harms the bytes of a file somewhere; `records` are rows of the log as they lie in it.
void harm(std::string& bytes, const std::vector<std::string>& records, Random& random) {
    constexpr std::size_t page = 4096, sector = 512;
    const std::size_t at = random.between(0, bytes.size() - 1);
    switch (random.between(0, 9)) {
        case 0:
            for (std::size_t k = at; k < std::min(bytes.size(), at + random.between(1, 64)); ++k)
                bytes[k] = static_cast<char>(random.between(0, 255));
            return;
        case 1:
            bytes.replace(at / sector * sector, sector, sector, '\0');
            return;
        case 2:
            return bytes.resize(at);
        case 3: {
            const auto start = bytes.begin() + static_cast<std::ptrdiff_t>(at / page * page);
            const std::size_t other = random.between(0, bytes.size() / page - 1) * page;
            std::swap_ranges(start, start + page, bytes.begin() + static_cast<std::ptrdiff_t>(other));
            return;
        }
        case 4:
        case 5:
        case 6: {
            const std::string& record = records[random.between(0, records.size() - 1)];
            const std::size_t place = bytes.find(record);
            return flip_bit_at(bytes, place + random.between(0, record.size() - 1), random);
        }
        default:
            return flip_bit_at(bytes, at, random);
    }
}

std::vector<std::string> records_of(const std::filesystem::path& path) {
    std::vector<std::string> records;
    const Store store = Store::open(path).value();
    const auto events = store.read([](const Reader& reader) { return reader.events({}); });
    for (const auto& [seq, bytes] : events.value()) records.push_back(bytes);
    return records;
}

/// Whether the harm was found. What the harm left as it was need not be: a file has bytes that say nothing.
void expect_found(const Original& original, const std::filesystem::path& copy, const Content& before,
                  std::size_t& effective) {
    const auto findings = verify_store(copy, original.trust);
    const auto now = content_of(copy);
    if (now == before) return;
    ++effective;
    if (!findings) return;  // it does not open at all
    INFO(all_text(*findings));
    REQUIRE_FALSE(findings->empty());
    const bool broken_apart = std::any_of(findings->begin(), findings->end(), [](const AuditFinding& one) {
        return one.place == "pages" || one.place == "store";
    });
    if (!now || broken_apart) return;  // then it is not one record that was changed
    const std::set<Seq> touched = changed_records(before, *now);
    bool named = touched.empty();
    for (const Seq seq : touched) named = named || names_record(*findings, seq);
    if (!named) UNSCOPED_INFO("record " << *touched.begin() << " is not named");
    REQUIRE(named);
}

void harm_bytes(std::size_t attempts) {
    const Original original;
    const auto records = records_of(original.path);
    const std::string whole = read_file(original.path).value();
    for (const std::string& record : records) REQUIRE(whole.find(record) != std::string::npos);
    const Content before = content_of(original.path).value();
    const auto copy = original.folder / "copy.db";
    std::size_t effective = 0;
    weave::testing::for_all(
        [&](Random& random) {
            std::string bytes = whole;
            harm(bytes, records, random);
            for (const char* more : {"-wal", "-shm"}) std::filesystem::remove(copy.string() + more);
            REQUIRE(write_file(copy, bytes));
            expect_found(original, copy, before, effective);
        },
        attempts);
    std::printf("%zu of %zu changed what the store says; all of them were found\n", effective, attempts);
    REQUIRE(effective > attempts / 3);
}

}  // namespace

TEST_CASE("random tampering with records, objects and tree in the file is found, and the record named", "[file]") {
    tamper(300);
}

TEST_CASE("10,000 random tamperings with the file are found, and the record named", "[.][long][file]") {
    tamper(10000);
}

TEST_CASE("random harm to the bytes of the file is found, and the record named", "[file]") {
    harm_bytes(300);
}

TEST_CASE("10,000 random harms to the bytes of the file are found, and the record named", "[.][long][file]") {
    harm_bytes(10000);
}

TEST_CASE("an older copy is clean by itself, and found by the retained head alone", "[file]") {
    const Original original;
    for (const auto& [records, path] : original.older) {
        StoreTrust trust = original.trust;
        REQUIRE(names_record(verify_store(path, trust).value(), records));
        trust.retained = original.older_heads.at(records);
        REQUIRE(all_text(verify_store(path, trust).value()).empty());
        REQUIRE(all_text(verify_store(original.path, trust).value()).empty());
    }
}

TEST_CASE("a store that somebody rewrote as a whole, tree and all, is found by its signatures and the retained "
    "head", "[file]") {
    const Original original;
    const Folder folder;
    {
        Store forged = Store::create(folder / "s.db", "mill").value();
        for (std::uint64_t k = 0; k < Original::size; ++k)
            REQUIRE(forged.write([&](Writer& writer) { return note(writer, k + 1); }));
    }
    const auto findings = verify_store(folder / "s.db", original.trust).value();
    REQUIRE(has_words(findings, "retained head"));
}

}  // namespace weave::loomlink::testing
