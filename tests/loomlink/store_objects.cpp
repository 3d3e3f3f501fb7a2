#include "store_case.hpp"

#include <loomlink/store/chunks.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::Random;

namespace {

std::string random_bytes(Random& random, std::size_t count) {
    std::string bytes(count, '\0');
    for (char& c : bytes) c = static_cast<char>(random.between(0, 255));
    return bytes;
}

/// Twenty megabytes as a document with a large card has them: rows of numbers that repeat little.
std::string large_document() {
    std::string text;
    std::uint64_t state = 1;
    while (text.size() < 20'000'000) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        text += std::to_string(state >> 40) + (state >> 61 == 0 ? "\n" : ",");
    }
    return text;
}

Result<Hash> put(Store& store, const std::string& bytes) {
    return store.write([&](Writer& writer) { return writer.put_object(bytes); });
}
Result<std::optional<std::string>> get(const Store& store, const Hash& hash) {
    return store.read([&](const Reader& reader) { return reader.object(hash); });
}

}  // namespace

TEST_CASE("chunks join to what was cut, and keep to their bounds") {
    weave::testing::for_all(
        [](Random& random) {
            const std::string bytes = random_bytes(random, random.between(0, 300'000));
            std::string joined;
            const auto chunks = cut_into_chunks(bytes);
            for (std::size_t k = 0; k < chunks.size(); ++k) {
                REQUIRE(chunks[k].size() <= most_chunk);
                if (k + 1 < chunks.size()) REQUIRE(chunks[k].size() > least_chunk);
                joined += chunks[k];
            }
            REQUIRE(joined == bytes);
        },
        20);
    REQUIRE(cut_into_chunks("").empty());
    REQUIRE(cut_into_chunks(std::string(200'000, 'x')).size() <= 200'000 / least_chunk);
}

TEST_CASE("objects come back as they were, whatever is in them") {
    const Folder folder;
    Store store = Store::create(folder.store("s.db"), "mill").value();
    weave::testing::for_all(
        [&](Random& random) {
            const std::string bytes = random.coin() ? random_bytes(random, random.between(0, 100'000))
                                                    : std::string(random.between(0, 100'000), 'w');
            const Hash hash = put(store, bytes).value();
            REQUIRE(hash == sha256(bytes));
            REQUIRE(get(store, hash).value() == bytes);
        },
        20);
    REQUIRE(get(store, put(store, "").value()).value() == "");
    REQUIRE_FALSE(get(store, sha256("not there")).value());
    REQUIRE(all_text(verify_store(folder.store("s.db")).value()).empty());
}

TEST_CASE("a small edit of a document of 20 MB adds kilobytes", "[file]") {
    const Folder folder;
    const auto size = [&] { return std::filesystem::file_size(folder / "s.db"); };
    std::string document = large_document();
    const auto save = [&] {
        Store store = Store::open(folder.store("s.db")).value();  // closing it folds the WAL in
        REQUIRE(put(store, document));
    };
    { const Store store = Store::create(folder.store("s.db"), "mill").value(); }
    save();
    const auto first = size();
    document[document.size() / 2] = '#';
    save();
    const auto changed = size();
    document.insert(document.size() / 3, "1,2,3");  // everything behind it moves
    save();
    const auto inserted = size();
    WARN("20 MB took " << first << " bytes; one changed byte added " << changed - first << ", an insertion "
                       << inserted - changed);
    REQUIRE(first > 4'000'000);
    REQUIRE(changed - first < 200'000);
    REQUIRE(inserted - changed < 300'000);
    Store store = Store::open(folder.store("s.db")).value();
    REQUIRE(get(store, sha256(document)).value() == document);
}

TEST_CASE("a damaged object is an error and is never given out") {
    const Folder folder;
    const auto path = folder.store("s.db");
    Hash hash{};
    {
        Store store = Store::create(path, "mill").value();
        hash = put(store, "the card of the shoe").value();
    }
    tamper_with(path,
                "DROP TRIGGER chunk_no_update; UPDATE chunk SET bytes = CAST('the card of the hat!' AS "
                "BLOB), packed = 0");
    const Store store = Store::open(path).value();
    REQUIRE_THAT(text_of(get(store, hash)), Catch::Contains("damaged"));
    REQUIRE_THAT(all_text(verify_store(path).value()),
                 Catch::Contains("object " + hash_hex(hash)));
}

TEST_CASE("an object that is too large is refused") {
    const Folder folder;
    Store store = Store::create(folder.store("s.db"), "mill").value();
    REQUIRE_THAT(text_of(put(store, std::string(largest_object + 1, 'x'))), Catch::Contains("larger than"));
}
