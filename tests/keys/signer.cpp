#include <weave/core/file.hpp>
#include <weave/keys/server_key.hpp>
#include <weave/keys/signer.hpp>

#include <catch2/catch.hpp>

#include <support/refusals.hpp>
#include <support/temporary_folder.hpp>

using namespace weave;
using testing::check_refused;

TEST_CASE("a machine's key and the note beside it say who signs for whom") {
    const testing::TemporaryFolder folder;
    const auto file = folder.path / "evidence.key";
    const KeyPair key = create_server_key(file, ServerKeyRole::evidence).value();
    check_refused(load_signer(file), "evidence.key.site: is missing");
    REQUIRE(save_signer_note(file, {key.id(), "mill", "gpu-1"}));
    const Signer signer = load_signer(file).value();
    CHECK(signer.key.public_key() == key.public_key());
    CHECK(signer.site == "mill");
    CHECK(signer.name == "gpu-1");
    check_refused(save_signer_note(file, {key.id(), "", "gpu-1"}), "site");
    CHECK(load_signer(file).value().site == "mill");

    REQUIRE(save_signer_note(file, {KeyPair::generate().id(), "mill", "gpu-1"}));
    check_refused(load_signer(file), "is of another key than the one beside it");
    for (const char* bytes : {"", "{}", "[]", R"({"format":"weave-signer","key":"","name":"a","site":"b","version":1})",
                              R"({"format":"weave-signer","name":"a","site":"b","version":1})"}) {
        REQUIRE(write_file(signer_note(file), bytes));
        INFO(bytes);
        CHECK_FALSE(load_signer(file));
    }
    REQUIRE(write_file(signer_note(file), std::string(5000, ' ')));
    check_refused(load_signer(file), "larger than the limit");
    check_refused(load_signer(folder.path / "none.key"), "cannot open");
}

TEST_CASE("a key for something else is no machine's") {
    const testing::TemporaryFolder folder;
    const auto file = folder.path / "access.key";
    const KeyPair key = create_server_key(file, ServerKeyRole::access).value();
    CHECK(load_server_key(file, ServerKeyRole::access).value().id() == key.id());
    REQUIRE(save_signer_note(file, {key.id(), "mill", "gpu-1"}));
    check_refused(load_signer(file), "is a key for another use");
}
