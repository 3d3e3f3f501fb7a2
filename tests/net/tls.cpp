#include "service.hpp"

#include <weave/core/file.hpp>

using namespace weave;
using namespace weave::net;
using namespace weave::net::testing;

namespace {

/// A server with a certificate of its own for these names.
struct Secured {
    Folder folder;
    CertificateFacts facts;
    Server server;

    explicit Secured(const std::vector<std::string>& names = {"127.0.0.1"})
        : facts(made(folder, names)), server(started(usual_routes(), options(folder))) {}

    static CertificateFacts made(const Folder& folder, const std::vector<std::string>& names) {
        auto facts = make_certificate(folder.tls(), names);
        REQUIRE(facts);
        return *facts;
    }
    static ServerOptions options(const Folder& folder) {
        ServerOptions options;
        options.tls = folder.tls();
        return options;
    }
    [[nodiscard]] ClientOptions pinned() const {
        ClientOptions options = client_of(server);
        options.tls = Trust{{}, facts.fingerprint};
        return options;
    }
};

Result<Response> greet(const ClientOptions& options) {
    return HttpClient(options).send({"GET", "/hello", {}, {}});
}

}  // namespace

TEST_CASE("a pinned certificate is enough, and a connection is kept over TLS") {
    Secured secured;
    HttpClient client(secured.pinned());
    for (int k = 0; k < 3; ++k) {
        const auto answered = client.send({"GET", "/hello", {}, {}});
        REQUIRE(answered);
        REQUIRE(*answered->body == "hello");
        REQUIRE(answered->headers.get("Strict-Transport-Security") == "max-age=31536000");
    }
    ClientOptions upper = secured.pinned();
    for (char& c : upper.tls->fingerprint) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    REQUIRE(greet(upper));
}

TEST_CASE("another certificate than the pinned one is refused") {
    Secured secured;
    ClientOptions wrong = secured.pinned();
    wrong.tls->fingerprint[0] = wrong.tls->fingerprint[0] == '0' ? '1' : '0';
    const auto answered = greet(wrong);
    REQUIRE_FALSE(answered);
    REQUIRE(answered.error().code == ErrorCode::refused);
    CHECK(answered.error().message.find("its fingerprint is " + secured.pinned().tls->fingerprint + ", not " + wrong.tls->fingerprint) != std::string::npos);
    wrong.tls->fingerprint = "00";
    REQUIRE(greet(wrong).error().code == ErrorCode::refused);
}

TEST_CASE("a certificate is trusted by the file of its authority, and by nothing else") {
    Secured secured, other;
    ClientOptions options = client_of(secured.server);
    options.tls = Trust{secured.folder.tls().certificate, {}};
    REQUIRE(greet(options));
    options.tls = Trust{other.folder.tls().certificate, {}};
    REQUIRE(greet(options).error().code == ErrorCode::refused);
    options.tls = Trust{};  // the system's authorities do not know it
    REQUIRE(greet(options).error().code == ErrorCode::refused);
    options.tls = Trust{secured.folder.path / "missing.pem", {}};
    REQUIRE(greet(options).error().code == ErrorCode::bad_input);
}

TEST_CASE("a certificate for another host is refused, pinned or signed") {
    Secured secured({"loom.example", "127.0.0.2"});
    REQUIRE(greet(secured.pinned()).error().code == ErrorCode::refused);
    ClientOptions options = client_of(secured.server);
    options.tls = Trust{secured.folder.tls().certificate, {}};
    REQUIRE(greet(options).error().code == ErrorCode::refused);
}

TEST_CASE("plain HTTP to a TLS port, and TLS to a plain port, end in an error and harm nothing") {
    Secured secured;
    REQUIRE_FALSE(greet(client_of(secured.server)));
    RawSocket raw(secured.server.port());
    raw.send("GET /hello HTTP/1.1\r\nHost: x\r\n\r\n");
    REQUIRE(raw.read_all().find("hello") == std::string::npos);
    REQUIRE(raw.closed());
    ServerOptions brief;
    brief.limits.header_time = 500ms;  // what is no HTTP may seem a head that has not ended
    const Server plain = started(usual_routes(), brief);
    ClientOptions options = client_of(plain);
    options.tls = Trust{{}, secured.facts.fingerprint};
    REQUIRE_FALSE(greet(options));
    REQUIRE(greet(secured.pinned()));
    REQUIRE(greet(client_of(plain)));
}

TEST_CASE("files that are no certificate and key to each other are refused") {
    Secured secured, other;
    const auto start = [](const TlsFiles& files) {
        ServerOptions options;
        options.tls = files;
        return Server::start(usual_routes(), options);
    };
    const auto mixed = start({secured.folder.tls().certificate, other.folder.tls().key});
    REQUIRE_FALSE(mixed);
    REQUIRE(mixed.error().code == ErrorCode::bad_input);
    REQUIRE_FALSE(start({secured.folder.tls().key, secured.folder.tls().key}));
    REQUIRE_FALSE(start({secured.folder.path / "missing", secured.folder.tls().key}));
}

TEST_CASE("a large answer arrives whole over TLS, many at a time from the same bytes") {
    Folder folder;
    const CertificateFacts facts = Secured::made(folder, {"127.0.0.1"});
    std::string content(5 << 20, '\0');
    for (std::size_t k = 0; k < content.size(); ++k) content[k] = static_cast<char>(k * 2654435761u >> 13);
    const Bytes large = make_bytes(content);
    Router router;
    REQUIRE(router.add({"large",
                        "GET",
                        "/large",
                        "Gives much",
                        0,
                        [&](const Request&) { return answer(200, "application/octet-stream", large); },
                        {}}));
    const Server server = started(std::move(router), Secured::options(folder));
    ClientOptions options = client_of(server);
    options.tls = Trust{{}, facts.fingerprint};
    HttpClient client(options);
    for (int k = 0; k < 3; ++k) {
        const auto answered = client.send({"GET", "/large", {}, {}});
        REQUIRE(answered);
        REQUIRE(*answered->body == content);
    }
}
