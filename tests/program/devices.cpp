// `devices`: what the simulator can run on, here and anywhere.

#include "run.hpp"

using program_tests::Workshop;
using weave::Json;

TEST_CASE("devices are listed, or it is said why there are none", "[devices]") {
    const Workshop shop;
    const Json answer = shop.json({"devices"});
    CHECK(answer.at("processor").at("cores") >= 1);
    bool is_any_usable = false;
    for (const Json& device : answer.at("devices")) {
        CHECK(answer.at("built_with_cuda") == true);
        CHECK(device.at("number").is_number_unsigned());
        CHECK(device.at("usable").is_boolean());
        if (device.at("usable") == false) CHECK(device.at("trouble").get<std::string>().size() > 3);
        if (device.at("usable") == false) continue;
        is_any_usable = true;
        CHECK(!device.at("name").get<std::string>().empty());
        CHECK(device.at("memory_bytes") >= device.at("free_bytes"));
        CHECK(device.at("multiprocessors") >= 1);
        CHECK(device.at("compute_capability").get<std::string>().find('.') != std::string::npos);
    }
    CHECK(answer.at("why_none").is_string() == !is_any_usable);

    const std::string words = shop.must({"devices"}).out;
    CHECK(words.rfind("processor: ", 0) == 0);
    for (const Json& device : answer.at("devices")) CHECK(words.find(device.at("name").get<std::string>()) != std::string::npos);
    if (answer.at("devices").empty()) CHECK(words.find("no device: " + answer.at("why_none").get<std::string>()) != std::string::npos);
}

TEST_CASE("devices takes no file and says so", "[devices]") {
    const Workshop shop;
    shop.refused({"devices", "a.weave"}, 2, {"a.weave"});
}
