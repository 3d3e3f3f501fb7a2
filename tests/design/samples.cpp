#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>

#include <catch2/catch.hpp>

using namespace weave;

TEST_CASE("every shipped design is a document that reads back equal, with the same bytes, hashes and cloth") {
    REQUIRE_FALSE(samples().empty());
    for (const Sample& sample : samples()) {
        INFO(sample.name);
        const Design design = sample.make();
        REQUIRE(check(design));
        const std::string text = write_document(design);
        const Result<Design> back = read_document(text);
        if (!back) FAIL(back.error().text());
        CHECK((*back == design));
        CHECK((write_document(*back) == text));
        CHECK(design_sha256(*back) == design_sha256(design));
        CHECK(scene_sha256(*back) == scene_sha256(design));
        CHECK(design_sha256(sample.make()) == design_sha256(design));
        CHECK((*evaluate(*back).value().block == *evaluate(design).value().block));
    }
}
