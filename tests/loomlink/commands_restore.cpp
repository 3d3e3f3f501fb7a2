// restore over a site that is not the backup's past: what would be lost is told, and what is replaced stays.

#include "commands_case.hpp"
#include "server_case.hpp"

namespace weave::loomlink::testing {

namespace fs = std::filesystem;

namespace {

/// The exit status of `verify`, of a folder or of a store that was kept, with the keys of a folder.
int verified(const CommandMill& mill, const fs::path& folder, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"verify", folder.string()});
    return mill.run(more).code;
}

/// A folder that serves what a restore has kept.
fs::path site_of_kept(const CommandMill& mill, const fs::path& site, const std::string& keys_end) {
    const fs::path folder = mill.at("kept");
    fs::create_directory(folder);
    fs::copy_file(site / "loomlink.db.replaced", folder / "loomlink.db");
    for (const std::string name : {"log.key", "stamp.key", "access.key", "tls.key", "tls.pem"})
        fs::copy_file(site / (name + keys_end), folder / name);
    return folder;
}

Ended restored(CommandMill& mill, const fs::path& site, const std::vector<std::string>& more) {
    std::vector<std::string> words{"restore", mill.at("backup"), site};
    words.insert(words.end(), more.begin(), more.end());
    return mill.run(words);
}

}  // namespace

TEST_CASE("a backup does not replace work that it has not, unless it is told to, and then that work is kept", "[commands][restore]") {
    CommandMill mill;
    mill.set_up();
    REQUIRE(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    mill.save("twill-2-2");
    mill.done("emil", {"audit", "head", "-o", mill.at("head.json")});
    mill.stop();
    const auto restore = [&](const std::vector<std::string>& more = {}) { return restored(mill, mill.site_folder, more); };
    const Ended refused = restore();
    CHECK(refused.code == 4);
    CHECK_THAT(refused.err, Catch::Contains("records that the backup has not, the newest of 2") && Catch::Contains("by dora") &&
                                Catch::Contains("--replace") && Catch::Contains("loomlink.db.replaced"));
    CHECK(verified(mill, mill.site_folder, {"--retained", mill.at("head.json")}) == 0);
    CHECK_FALSE(fs::exists(mill.site_folder / "loomlink.db.replaced"));

    const Ended replaced = restore({"--replace"});
    INFO(replaced.err);
    REQUIRE(replaced.code == 0);
    CHECK_THAT(replaced.out, Catch::Contains("is kept as") && Catch::Contains("loomlink.db.replaced"));
    CHECK(verified(mill, mill.site_folder) == 0);
    CHECK(verified(mill, mill.site_folder, {"--retained", mill.at("head.json")}) == 1);
    CHECK(verified(mill, site_of_kept(mill, mill.site_folder, ""), {"--retained", mill.at("head.json")}) == 0);

    const Ended again = restore();  // nothing would be lost, but for the one that is kept
    CHECK(again.code == 4);
    CHECK_THAT(again.err, Catch::Contains("loomlink.db.replaced: is in the way"));
    fs::remove(mill.site_folder / "loomlink.db.replaced");
    CHECK(restore().code == 0);
}

TEST_CASE("a backup of one site does not replace another, unless it is told to, and then its keys come with it", "[commands][restore]") {
    CommandMill mill, other;
    mill.set_up();
    other.set_up();
    REQUIRE(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    mill.stop();
    other.stop();
    const auto restore = [&](const std::vector<std::string>& more = {}) { return restored(mill, other.site_folder, more); };
    const Ended refused = restore();
    CHECK(refused.code == 4);
    CHECK_THAT(refused.err, Catch::Contains("holds another site than the backup") && Catch::Contains("trust.published, by mary"));
    CHECK_FALSE(fs::exists(other.site_folder / "log.key.replaced"));
    const Ended replaced = restore({"--replace"});
    INFO(replaced.err);
    REQUIRE(replaced.code == 0);
    CHECK(verified(mill, other.site_folder) == 0);
    CHECK(read_file(other.site_folder / "log.key").value() == read_file(mill.site_folder / "log.key").value());
    CHECK(verified(mill, site_of_kept(mill, other.site_folder, ".replaced")) == 0);
}

TEST_CASE("a store that is damaged is replaced where that is asked for, and kept as it is", "[commands][restore][file]") {
    CommandMill mill;
    mill.set_up();
    REQUIRE(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    mill.stop();
    const std::string noise(8192, '.');
    REQUIRE(write_file(mill.site_folder / "loomlink.db", noise));
    REQUIRE(write_file(mill.site_folder / "loomlink.db-wal", "what was not in it yet"));
    const Ended refused = mill.run({"restore", mill.at("backup"), mill.site_folder});
    CHECK(refused.code == 4);
    CHECK_THAT(refused.err, Catch::Contains("cannot be read (") && Catch::Contains("nobody can say what would be lost"));
    const Ended replaced = mill.run({"restore", mill.at("backup"), mill.site_folder, "--replace"});
    INFO(replaced.err);
    REQUIRE(replaced.code == 0);
    CHECK(verified(mill, mill.site_folder) == 0);
    CHECK(read_file(mill.site_folder / "loomlink.db.replaced").value() == noise);
}

TEST_CASE("the store that a database held is kept as a file when a backup replaces it", "[commands][restore][server]") {
    if (there_is_no_server()) return;
    CommandMill mill;
    mill.set_up();
    REQUIRE(mill.run({"backup", mill.site_folder, mill.at("backup")}).code == 0);
    mill.save("twill-2-2");
    mill.done("emil", {"audit", "head", "-o", mill.at("head.json")});
    mill.stop();
    if (!stores_are_on_server()) {
        PostgresServer& server = PostgresServer::shared();
        REQUIRE(mill.run({"migrate-store", mill.site_folder, server.place(server.make_database())}).code == 0);
    }
    CHECK(mill.run({"restore", mill.at("backup"), mill.site_folder}).code == 4);
    CHECK_FALSE(fs::exists(mill.site_folder / "loomlink.db.replaced"));
    const Ended replaced = mill.run({"restore", mill.at("backup"), mill.site_folder, "--replace", "--json"});
    INFO(replaced.err);
    REQUIRE(replaced.code == 0);
    CHECK(replaced.json().at("replaced") == (mill.site_folder / "loomlink.db.replaced").string());
    CHECK(verified(mill, mill.site_folder) == 0);
    CHECK(verified(mill, site_of_kept(mill, mill.site_folder, ""), {"--retained", mill.at("head.json")}) == 0);
}

}  // namespace weave::loomlink::testing
