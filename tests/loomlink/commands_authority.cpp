#include "commands_case.hpp"
#include "test_authority.hpp"

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;

namespace {

/// A site whose certificate a mill's own authority has signed for these names.
struct CertifiedMill {
    TestAuthority authority;
    CommandMill mill;

    explicit CertifiedMill(const char* names) {
        authority.write(mill.at("authority.pem"));
        serve(names);
    }
    void serve(const char* names) {
        mill.certificate = mill.at("server.pem");
        mill.key = mill.at("server.key");
        authority.certify(names, mill.certificate, mill.key);
        mill.stop();
        mill.start();
    }
    /// A command on a machine where the system's authorities are those of a file.
    [[nodiscard]] Ended run(const std::vector<std::string>& words, const std::string& authorities) const {
        return Running(mill.words_of("mary", words), mill.folder.path, "",
                       {"SSL_CERT_FILE=" + mill.at(authorities).string()})
            .wait();
    }
    [[nodiscard]] Ended join(const std::string& authorities) const {
        return run({"user", "join", mill.introduction.at("invitation").get<std::string>(), "--name", "mary",
                    "--full-name", "Mary", "--password-file", mill.at("password")},
                   authorities);
    }
};

}  // namespace

TEST_CASE("a server whose certificate an authority of the system signed needs no fingerprint", "[commands]") {
    const CertifiedMill certified("IP:127.0.0.1");
    const Ended joined = certified.join("authority.pem");
    INFO(joined.err);
    REQUIRE(joined.code == 0);
    CHECK(parse_json(read_file(certified.mill.at("mary")).value()).value().at("fingerprint") == "");
    CHECK(certified.run({"me"}, "authority.pem").code == 0);
    CHECK(certified.run({"login", "--password-file", certified.mill.at("password")}, "authority.pem").code ==
          0);
}

TEST_CASE("a server is refused where the system knows none of its authorities", "[commands]") {
    const CertifiedMill certified("IP:127.0.0.1");
    TestAuthority().write(certified.mill.at("other.pem"));  // of the same name, with another key
    const Ended joined = certified.join("other.pem");
    CHECK(joined.code == 4);
    CHECK_THAT(joined.err, Catch::Contains("not trusted"));
    CHECK_FALSE(std::filesystem::exists(certified.mill.at("mary")));
    REQUIRE(certified.join("authority.pem").code == 0);
    CHECK(certified.run({"me"}, "other.pem").code == 4);
    CHECK(certified.mill.as("mary", {"me"}).code == 4);  // the authorities of this machine
}

TEST_CASE("what an authority signed for another host is refused", "[commands]") {
    const CertifiedMill certified("DNS:loom.example,IP:127.0.0.2");
    CHECK(certified.join("authority.pem").code == 4);
    CHECK_FALSE(std::filesystem::exists(certified.mill.at("mary")));
}

TEST_CASE("a fingerprint decides alone, whatever the system's authorities say", "[commands]") {
    const CertifiedMill certified("IP:127.0.0.1");
    const auto log_in = [&](const std::string& fingerprint) {
        return certified
            .run({"login", certified.mill.url(), "--name", "mary", "--fingerprint", fingerprint,
                  "--password-file", certified.mill.at("password")},
                 "authority.pem")
            .code;
    };
    certified.mill.first_joins();
    CHECK(log_in(std::string(64, 'a')) == 4);
    CHECK(log_in(certified.mill.fingerprint()) == 0);
    CHECK(certified.mill.as("mary", {"me"}).code == 0);
}
