#pragma once

#include <weave/core/json.hpp>
#include <weave/curve/vec3.hpp>
#include <weave/sim/scene.hpp>

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace weave::sim {

/// Control points as the bytes of their doubles, one member a yarn, for CBOR.
inline Json points_json(const std::vector<std::vector<Vec3>>& control) {
    static_assert(std::endian::native == std::endian::little);
    Json list = Json::array();
    for (const std::vector<Vec3>& points : control) {
        std::vector<std::uint8_t> bytes(points.size() * 3 * sizeof(double));
        for (std::size_t i = 0; i < points.size(); ++i) std::memcpy(&bytes[24 * i], points[i].data(), 24);
        list.push_back(Json::binary(std::move(bytes)));
    }
    return list;
}

/// The points of each yarn of a scene. Throws where there are not as many, or they are no numbers.
inline std::vector<std::vector<Vec3>> points_from(const Json& json, const SimScene& scene) {
    if (json.size() != scene.yarns.size()) throw std::out_of_range("other yarns");
    std::vector<std::vector<Vec3>> control;
    for (std::size_t y = 0; y < scene.yarns.size(); ++y) {
        const std::vector<std::uint8_t>& bytes = json.at(y).get_binary();
        std::vector<Vec3> points(scene.yarns[y].control.size());
        if (bytes.size() != 24 * points.size()) throw std::out_of_range("other points");
        for (std::size_t i = 0; i < points.size(); ++i) {
            std::memcpy(points[i].data(), &bytes[24 * i], 24);
            if (!points[i].allFinite()) throw std::out_of_range("no numbers");
        }
        control.push_back(std::move(points));
    }
    return control;
}

}  // namespace weave::sim
