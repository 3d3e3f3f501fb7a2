#include "site.hpp"

#include <catch2/catch.hpp>

#include <loomlink/keys/file_name.hpp>

using namespace weave;
using namespace weave::loomlink;
using testing::check_refused;
using testing::Site;

TEST_CASE("file names that could do harm are refused, each for its reason") {
    for (const char* name : {"shoe.jc5", "A-1_b.tif", "a", "console.txt", "com.ep", "comet1", "nul1"})
        CHECK(check_file_name(name));
    const auto refused = [](std::string_view name, const char* words) {
        check_refused(check_file_name(name), words);
    };
    refused("", "is empty");
    refused(".", "may not start with a point");
    refused("..", "may not start with a point");
    refused(".hidden", "may not start with a point");
    refused("-rf", "may not start with a point or a hyphen");
    refused("../shoe", "leads into a folder");
    refused("a/b", "leads into a folder");
    refused("/etc/passwd", "leads into a folder");
    refused("a\\b", "leads into a folder");
    refused("C:shoe", "letters, digits, points");
    refused("shoe ", "letters, digits, points");
    refused("a\nb", "letters, digits, points");
    refused(std::string_view("a\0b", 3), "letters, digits, points");
    refused("sch\xc3\xb6n", "letters, digits, points");
    refused("a*b", "letters, digits, points");
    refused("shoe.", "may not end with a point");
    for (const char* name : {"con", "CON.txt", "Nul", "aux.jc5", "prn", "com1", "LPT9.ep", "com0"})
        refused(name, "is the name of a device");
    refused(std::string(101, 'a'), "more than 100 characters");
    CHECK(check_file_name(std::string(100, 'a')));
}

TEST_CASE("a head of the log is the log key's, of this site") {
    const Site site;
    const TrustDocument trust = site.trust();
    const SignedLogHead head = site.head(5, site.log);
    CHECK(check_head(head, trust));
    CHECK(head_from_json(to_json(head)).value() == head);
    check_refused(check_head(site.head(5, site.stamp), trust), "does not have the role log");
    check_refused(check_head(site.head(5, site.thief), trust), "unknown or revoked");
    SignedLogHead changed = head;
    changed.head.size = 6;
    check_refused(check_head(changed, trust), "forged or altered");
    check_refused(check_head(sign_head(site.log, {"other", 5, Site::root_of(5), Site::at(0)}), trust),
                  "is the head of the log of 'other'");
    Json json = to_json(head);
    json["head"]["size"] = 0;
    check_refused(head_from_json(json), "head.size");
}
