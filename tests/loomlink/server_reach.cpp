// A store on a server that is away: who asks is told that, and whether something was recorded.

#include "commands_case.hpp"
#include "server_case.hpp"

#include <loomlink/service/gate.hpp>
#include <loomlink/store/reach.hpp>

namespace weave::loomlink::testing {

TEST_CASE("while the store's server is down people learn that nothing was recorded, and repeat it once it is back", "[commands][server]") {
    if (there_is_no_server()) return;
    PostgresServer server;
    CommandMill mill;
    mill.set_up();
    mill.save("twill-2-2");
    mill.stop();
    if (stores_are_on_server()) REQUIRE(mill.run({"migrate-store", mill.site_folder, "file"}).code == 0);
    REQUIRE(mill.run({"migrate-store", mill.site_folder, server.place(server.make_database())}).code == 0);
    ServeConfig config;
    config.port = mill.port;
    DeskSettings settings;
    settings.key_cost = settings.login_cost = test_cost();
    mill.site = got(RunningSite::start({mill.site_folder}, config, settings));
    const auto comment = [&] { return mill.as("dora", {"comment", "cloth", "1", "It is so"}); };
    server.kill();
    for (const auto& ended : {comment(), mill.as("dora", {"design", "list"})}) {
        INFO(ended.out << ended.err);
        CHECK(ended.code == 5);
        const std::string told = ended.json().at("error").at("message");
        CHECK_THAT(told, Catch::Contains("the store is out of reach: nothing was recorded; repeat it once the store is back"));
        CHECK_THAT(told, !Catch::Contains(server.folder().string()));
    }
    server.start();
    CHECK(comment().code == 0);
    CHECK(mill.done("dora", {"design", "show", "cloth", "1"}).at("comments").size() == 1);
    mill.stop();
}

TEST_CASE("a store that goes while it records says that nobody knows, and one that went before that nothing is there", "[server]") {
    if (there_is_no_server()) return;
    PostgresServer server;
    Store store = got(Store::create(server.place(server.make_database()), "mill"));
    const auto write = [&] { return store.write([](Writer& writer) { return note(writer); }); };
    REQUIRE(write());
    server.configure("synchronous_standby_names = 'gone'");
    server.reload();
    server.run("SELECT pg_sleep(1)");
    const auto late = write();
    REQUIRE_FALSE(late);
    INFO(late.error().text());
    CHECK(lost_of(late.error()) == Lost::in_commit);
    CHECK(trouble_answer(late.error()).status == 504);
    server.kill();
    const auto away = write();
    REQUIRE_FALSE(away);
    CHECK(lost_of(away.error()) == Lost::before);
    const auto unread = store.read([](const Reader& reader) { return reader.log_size(); });
    REQUIRE_FALSE(unread);
    CHECK(lost_of(unread.error()) == Lost::before);
    CHECK(trouble_answer(unread.error()).status == 503);
    CHECK_FALSE(lost_of(system_fault("the disk is full")));
}

}  // namespace weave::loomlink::testing
