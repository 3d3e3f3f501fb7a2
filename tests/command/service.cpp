// What both services are told of how they serve: read, held together, its places tried, and its errors told where they came from.

#include <weave/command/config_options.hpp>
#include <weave/command/service_places.hpp>
#include <weave/command/serving.hpp>
#include <weave/core/file.hpp>
#include <weave/net/certificate.hpp>
#include <weave/net/unix_socket.hpp>

#include <catch2/catch.hpp>

#include <netinet/in.h>
#include <support/temporary_folder.hpp>
#include <sys/socket.h>

using namespace weave;
using weave::testing::TemporaryFolder;

namespace {

namespace fs = std::filesystem;

/// Somebody else's server, on a free port.
class Taken {
  public:
    Taken() : m_socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in place{};
        place.sin_family = AF_INET;
        place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof place;
        auto* const any = reinterpret_cast<sockaddr*>(&place);
        REQUIRE(::bind(m_socket.number(), any, size) == 0);
        REQUIRE(::listen(m_socket.number(), 1) == 0);
        REQUIRE(::getsockname(m_socket.number(), any, &size) == 0);
        port = ntohs(place.sin_port);
    }
    std::uint16_t port = 0;

  private:
    Descriptor m_socket;
};

struct Told : ServiceConfig {
    std::string name = "usual";
};

Result<Told> parse(std::string_view text, const fs::path& folder) {
    WEAVE_TRY(const Json json, parse_json(text));
    JsonReader reader(json, "");
    Told told;
    read_service(reader, folder, told);
    told.name = reader.text("name", told.name);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return told;
}

/// What a service makes of a call, and the error it tells.
struct Called {
    Told told;
    std::string error;
};

Called call(std::vector<std::string> words, const std::function<Status(const Told&)>& check = check_service_places) {
    CLI::App app("Serves.", "mill");
    Called called;
    ConfigOptions options(&app, "README.md");
    options.add_service(called.told);
    options.add("--name", "name", called.told.name, "its name");
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app.parse(words);
    const Status status = options.complete<Told>(called.told, parse, check);
    if (!status) called.error = status.error().text();
    return called;
}

Error error_of(const ServiceConfig& config) {
    const Status status = check_service_places(config);
    REQUIRE_FALSE(status);
    return status.error();
}

ServiceConfig at_any_port() {
    ServiceConfig config;
    config.port = 0;
    return config;
}

}  // namespace

TEST_CASE("clients come by the names that are told, or by this machine's") {
    ServiceConfig config;
    const auto own = client_hosts(config);
    CHECK(std::ranges::count(own, "localhost") == 1);
    CHECK(std::ranges::count(own, "127.0.0.1") == 1);
    CHECK(std::ranges::all_of(own, net::can_be_certified));
    config.hosts = {"box.mill"};
    CHECK(client_hosts(config) == std::vector<std::string>{"box.mill", "127.0.0.1"});
    for (const char* everywhere : {"0.0.0.0", "::", ""}) {
        config.address = everywhere;
        CHECK(client_hosts(config) == config.hosts);
    }
    CHECK(origin_of(config, 8444) == "https://box.mill:8444");
    config.plain = true;
    config.address = "::1";
    CHECK(origin_of(config, 80) == "http://[::1]:80");
}

TEST_CASE("a number of a service is a whole one that it can be, and said to be so") {
    CHECK(call({"--port", "8444"}, [](const Told&) { return Status(); }).told.port == 8444);
    CHECK(call({"--port", "010"}, [](const Told&) { return Status(); }).told.port == 10);
    for (const char* port : {"70000", "65536", "-1", "abc", "8444x", "1e3", "99999999999999999999"}) {
        INFO(port);
        CHECK_THROWS_WITH(call({std::string("--port=") + port}), Catch::Contains("--port") && Catch::Contains("is not a whole number from 0 to 65535"));
    }
}

TEST_CASE("certificate, key and plain are held to one another") {
    const auto where = [](const std::string& text) {
        const auto told = parse(text, "");
        REQUIRE(told);
        const Status status = check_service(*told);
        return status ? "" : status.error().where;
    };
    CHECK(where(R"({"certificate":"x.pem"})") == "key");
    CHECK(where(R"({"key":"x.key"})") == "certificate");
    CHECK(where(R"({"plain":true,"certificate":"x.pem","key":"x.key"})") == "plain");
    CHECK(where(R"({"plain":true,"address":"0.0.0.0"})") == "address");
    for (const char* sound : {R"({"plain":true})", R"({"plain":true,"address":"::1"})", R"({"plain":true,"address":""})", R"({"address":"0.0.0.0"})"})
        CHECK(where(sound).empty());
}

TEST_CASE("address and port are tried before anything is served") {
    CHECK(check_service_places(at_any_port()));
    ServiceConfig config = at_any_port();
    {
        const Taken taken;
        config.port = taken.port;
        const Error error = error_of(config);
        CHECK(error.code == ErrorCode::system);
        CHECK(error.where == "port: 127.0.0.1:" + std::to_string(taken.port));
        CHECK_THAT(error.message, Catch::Contains("in use"));
    }
    CHECK(check_service_places(config));
    config.address = "192.0.2.1";  // nobody's (RFC 5737)
    CHECK(error_of(config).code == ErrorCode::system);
    CHECK_THAT(error_of(config).where, Catch::StartsWith("address: 192.0.2.1"));
    config.address = "here";
    CHECK(error_of(config).code == ErrorCode::bad_input);
    CHECK(error_of(config).where == "address: here");
    config.address = "";
    CHECK(check_service_places(config));
}

TEST_CASE("hosts that no certificate can stand for are found") {
    ServiceConfig config = at_any_port();
    config.hosts = {"box.mill", "10.0.0.7", "::1", "7.mill", "box-7"};
    CHECK(check_service_places(config));
    for (const std::string& wrong : std::vector<std::string>{"", "a b", "https://box", "-box", ".box", "b\nx", "böx", "a..b", "box-.mill", "1.2.3.4.5", "10.0.0", std::string(64, 'a')}) {
        INFO(wrong);
        config.hosts = {"box", wrong};
        CHECK(error_of(config).code == ErrorCode::bad_input);
        CHECK(error_of(config).where == "hosts[1]");
    }
}

TEST_CASE("certificate and key are read, held to one another, and the key is private") {
    const TemporaryFolder folder;
    const net::TlsFiles one{folder.path / "one.pem", folder.path / "one.key"}, other{folder.path / "other.pem", folder.path / "other.key"};
    ServiceConfig config = at_any_port();
    config.certificate = one.certificate;
    config.key = one.key;
    CHECK(error_of(config).where == "certificate: " + one.certificate.string());
    REQUIRE(net::make_certificate(one, {"localhost"}));
    REQUIRE(net::make_certificate(other, {"localhost"}));
    CHECK(check_service_places(config));
    config.key = other.key;
    CHECK(error_of(config).where == "key: " + other.key.string());
    config.key = folder.path / "none.key";
    CHECK(error_of(config).where == "key: " + config.key.string());
    config.key = one.key;
    fs::permissions(one.key, fs::perms(0644));
    CHECK(error_of(config).code == ErrorCode::refused);
    CHECK(error_of(config).where == "key: " + one.key.string());
}

TEST_CASE("a Unix socket is tried, and nothing is left of that") {
    const TemporaryFolder folder;
    const fs::path path = folder.path / "simd.sock";
    const auto error = [](const fs::path& socket, bool makes_folder = false) {
        const Status status = check_unix_socket(socket, makes_folder);
        REQUIRE_FALSE(status);
        CHECK(status.error().where == "unix_socket: " + socket.string());
        return status.error();
    };
    CHECK(check_unix_socket(path, false));
    CHECK(fs::is_empty(folder.path));
    const fs::path far = folder.path / "none" / "simd.sock", long_one = folder.path / std::string(108, 'x');
    CHECK_THAT(error(far).message, Catch::Contains("folder"));
    CHECK(check_unix_socket(far, true));
    for (const bool makes_folder : {false, true}) {
        CHECK(error(long_one, makes_folder).code == ErrorCode::bad_input);
        CHECK_THAT(error(long_one, makes_folder).message, Catch::Contains("107 bytes"));
    }
    {
        const auto server = net::UnixListener::open(path);
        REQUIRE(server);
        CHECK(error(path).code == ErrorCode::refused);
    }
    REQUIRE(write_file(path, "no socket"));
    CHECK(error(path).code == ErrorCode::refused);
    CHECK(read_file(path).value() == "no socket");
    if (::geteuid() != 0) {  // to whom nothing is read-only
        fs::create_directory(folder.path / "closed");
        fs::permissions(folder.path / "closed", fs::perms(0500));
        CHECK(error(folder.path / "closed" / "simd.sock").code == ErrorCode::system);
        fs::permissions(folder.path / "closed", fs::perms(0700));
    }
}

TEST_CASE("a service's folder is there, or can be made") {
    const TemporaryFolder folder;
    for (const fs::path& good : {folder.path, folder.path / "new", folder.path / "new" / "", fs::path("."), fs::path("new")})
        CHECK(check_service_folder(good));
    const Status missing = check_service_folder(folder.path / "mils" / "new");
    REQUIRE_FALSE(missing);
    CHECK(missing.error().code == ErrorCode::bad_input);
    CHECK(missing.error().where == (folder.path / "mils" / "new").string());
    CHECK(fs::is_empty(folder.path));
}

TEST_CASE("options count more than the file, whose paths count from its folder") {
    const TemporaryFolder folder;
    const std::string file = folder.path / "mill.json";
    REQUIRE(write_file(file, R"({"address":"0.0.0.0","port":9000,"hosts":["a"],"name":"filed","certificate":"tls/x.pem","key":"/etc/x.key"})"));
    const auto anything = [](const Told&) { return Status(); };
    const Told filed = call({"--config", file}, anything).told;
    CHECK(filed.port == 9000);
    CHECK(filed.name == "filed");
    CHECK(filed.certificate == folder.path / "tls/x.pem");
    CHECK(filed.key == "/etc/x.key");
    const Told both = call({"--port", "9001", "--host", "b", "--host", "c", "--cert", "y.pem", "--config", file, "--plain"}, anything).told;
    CHECK(both.address == "0.0.0.0");
    CHECK(both.port == 9001);
    CHECK(both.hosts == std::vector<std::string>{"b", "c"});
    CHECK(both.certificate == "y.pem");
    CHECK(both.plain);
    CHECK(call({"--address", "", "--name", ""}, anything).told.address.empty());
    CHECK(call({}, anything).told.name == "usual");
}

TEST_CASE("an error says the file and its member, or the option that was given in its place") {
    const TemporaryFolder folder;
    const std::string file = folder.path / "mill.json";
    const auto starts = [&](const std::string& text, std::vector<std::string> words, const std::string& start) {
        REQUIRE(write_file(file, text));
        words.insert(words.end(), {"--config", file});
        CHECK_THAT(call(words).error, Catch::StartsWith(start));
    };
    const std::string pem = (folder.path / "x.pem").string(), files = R"({"port":0,"certificate":"x.pem","key":"x.key"})";
    starts(R"({"prot":1})", {}, file + ": prot: ");
    starts(R"({"port":"x"})", {"--port", "0"}, file + ": port: ");
    starts(files, {}, file + ": certificate: " + pem + ": ");
    starts(files, {"--cert", "none.pem"}, "--cert: none.pem: ");
    starts(R"({"hosts":["a b"]})", {}, file + ": hosts[0]: ");
    starts("{}", {"--host", "a b"}, "--host[0]: ");
    const Taken taken;
    const std::string port = std::to_string(taken.port);
    starts(R"({"port":)" + port + "}", {}, file + ": port: 127.0.0.1:" + port + ": ");
    starts("{}", {"--port", port}, "--port: 127.0.0.1:" + port + ": ");
    CHECK_THAT(call({"--config", (folder.path / "none").string()}).error, Catch::StartsWith((folder.path / "none").string()));
    Told usual;
    usual.port = taken.port;
    CHECK(error_of(usual).where == "port: 127.0.0.1:" + port);  // neither file nor option
}
