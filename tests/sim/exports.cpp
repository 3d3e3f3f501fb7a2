#include <weave/sim/exports.hpp>
#include <weave/sim/sampled.hpp>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <cstring>
#include <map>
#include <sstream>
#include <support/demo_yarns.hpp>

using namespace weave;
using namespace weave::testing;

namespace {

/// The bytes of the data array of this name, its length in front taken off.
std::string array_of(const std::string& xml, const std::string& name) {
    const std::size_t tag = xml.find("Name=\"" + name + "\"");
    REQUIRE(tag != std::string::npos);
    const std::size_t first = xml.find('>', tag) + 1, last = xml.find('<', first);
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string bytes;
    unsigned group = 0, bits = 0;
    for (std::size_t k = first; k < last && xml[k] != '='; ++k) {
        group = group << 6 | static_cast<unsigned>(digits.find(xml[k]));
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes.push_back(static_cast<char>(group >> bits & 0xff));
    }
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data(), 8);
    CHECK(size == bytes.size() - 8);
    return bytes.substr(8);
}

template <class Number>
std::vector<Number> numbers(const std::string& bytes) {
    std::vector<Number> values(bytes.size() / sizeof(Number));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

struct Mesh {
    std::vector<Vec3> vertices, normals;
    std::vector<std::vector<std::pair<std::size_t, std::size_t>>> faces;  ///< vertex and normal, from 0
    std::vector<std::string> groups;
};

Mesh read_obj(const std::string& text) {
    Mesh mesh;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        if (kind == "v" || kind == "vn") {
            Vec3 place;
            words >> place.x() >> place.y() >> place.z();
            (kind == "v" ? mesh.vertices : mesh.normals).push_back(place);
        } else if (kind == "g") {
            mesh.groups.emplace_back(line.substr(2));
        } else if (kind == "f") {
            mesh.faces.emplace_back();
            std::size_t vertex = 0, normal = 0;
            char slash = 0;
            while (words >> vertex >> slash >> slash >> normal)
                mesh.faces.back().emplace_back(vertex - 1, normal - 1);
        }
    }
    return mesh;
}

}  // namespace

TEST_CASE("samples keep within their error, and follow a bend with few pieces") {
    Spline spline;
    for (int k = 0; k < 12; ++k)
        spline.control.push_back({0.5 * k, std::sin(1.3 * k), 0.3 * std::cos(2.1 * k)});
    for (const double error : {0.1, 0.01, 0.001}) {
        const auto at = sample_parameters(spline, error);
        CHECK(at.front() == 0);
        CHECK(at.back() == 11);
        double worst = 0;
        for (std::size_t k = 0; k + 1 < at.size(); ++k) {
            const Vec3 a = spline.place(at[k]), b = spline.place(at[k + 1]);
            for (const double share : {0.25, 0.5, 0.75}) {
                const Vec3 on = spline.place(at[k] + share * (at[k + 1] - at[k]));
                worst = std::max(worst, (on - (a + share * (b - a))).norm());
            }
        }
        CHECK(worst <= error * (1 + 1e-9));
        CHECK(worst > error / 8);
    }
    CHECK(sample_parameters({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, false, {}}, 0.01).size() == 3);
    CHECK(sample_parameters({}, 0.01).empty());
    CHECK(sample_parameters({{{0, 0, 0}, {1e9, 1e9, 0}, {0, 0, 0}}, false, {}}, 1e-9).size() ==
          2 * most_pieces + 1);
}

TEST_CASE("values change evenly between control points, and over the seam of a periodic yarn") {
    const Spline open{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, false, {0, 0, 0}};
    const Spline round{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, true, {3, 0, 0}};
    CHECK(value_at(open, {1, 2, 4}, 1.5) == 3);
    CHECK(value_at(open, {1, 2, 4}, 2) == 4);
    CHECK(value_at(round, {1, 2, 4}, 2.5) == 2.5);
    CHECK(value_at(round, {1, 2, 4}, 3) == 1);
}

TEST_CASE("the VTK file holds every yarn as a line with its numbers") {
    const Yarns yarns = plain_weave();
    const auto xml = write_vtp(yarns);
    REQUIRE(xml);
    const auto points = numbers<double>(array_of(*xml, "Points"));
    const auto radius = numbers<double>(array_of(*xml, "radius_mm"));
    const auto strain = numbers<double>(array_of(*xml, "strain"));
    const auto contact = numbers<double>(array_of(*xml, "contact_N"));
    const auto yarn = numbers<std::int32_t>(array_of(*xml, "yarn"));
    const auto system = numbers<std::uint8_t>(array_of(*xml, "system"));
    const auto connectivity = numbers<std::int64_t>(array_of(*xml, "connectivity"));
    const auto offsets = numbers<std::int64_t>(array_of(*xml, "offsets"));
    const std::size_t count = radius.size();
    CHECK(xml->find("NumberOfPoints=\"" + std::to_string(count) + "\"") != std::string::npos);
    CHECK(xml->find("NumberOfLines=\"16\"") != std::string::npos);
    REQUIRE((points.size() == 3 * count && strain.size() == count && contact.size() == count));
    REQUIRE((yarn.size() == count && system.size() == count && connectivity.size() == count &&
             offsets.size() == 16));
    CHECK(static_cast<std::size_t>(offsets.back()) == count);
    for (std::size_t line = 0; line < 16; ++line) {
        const SimulatedYarn& of = yarns.yarns[line];
        const auto first = static_cast<std::size_t>(line == 0 ? 0 : offsets[line - 1]);
        const auto last = static_cast<std::size_t>(offsets[line] - 1);
        CHECK((yarn[first] == static_cast<int>(of.number) + 1 && yarn[last] == yarn[first]));
        CHECK(system[first] == (of.system == System::warp ? 1 : 0));
        CHECK((radius[first] == of.radius_mm && strain[first] == of.strain[0] &&
               contact[last] == of.contact_N[0]));
        const Vec3 start = of.spline.place(0), end = of.spline.place(16);
        // x and y change places: see exports.hpp
        CHECK(Vec3(points[3 * first + 1], points[3 * first], points[3 * first + 2]) == start);
        CHECK(Vec3(points[3 * last + 1], points[3 * last], points[3 * last + 2]) == end);
        CHECK((end - start - of.spline.shift).norm() < 1e-12);
    }
    for (std::size_t k = 0; k < count; ++k) REQUIRE(connectivity[k] == static_cast<std::int64_t>(k));
}

TEST_CASE("the OBJ file holds closed round tubes that look outwards") {
    Yarns yarns = plain_weave();
    yarns.yarns = {yarns.yarns[0], yarns.yarns[9]};
    const Mesh mesh = read_obj(write_obj(yarns).value());
    CHECK(mesh.groups == std::vector<std::string>{"pick_1", "end_2"});
    std::map<std::pair<std::size_t, std::size_t>, int> edges;
    double volume = 0;
    for (const auto& face : mesh.faces) {
        for (std::size_t k = 0; k < face.size(); ++k) {
            REQUIRE((face[k].first < mesh.vertices.size() && face[k].second < mesh.normals.size()));
            ++edges[{face[k].first, face[(k + 1) % face.size()].first}];
        }
        const Vec3& a = mesh.vertices[face[0].first];
        for (std::size_t k = 1; k + 1 < face.size(); ++k) {
            const Vec3 &b = mesh.vertices[face[k].first], &c = mesh.vertices[face[k + 1].first];
            volume += a.dot(b.cross(c)) / 6;
        }
    }
    for (const auto& [edge, count] : edges) {
        REQUIRE(count == 1);
        REQUIRE(edges.contains({edge.second, edge.first}));
    }
    double expected = 0;
    for (const SimulatedYarn& yarn : yarns.yarns) {
        double length = 0;
        for (int k = 0; k < 1600; ++k)
            length += (yarn.spline.place((k + 1) / 100.0) - yarn.spline.place(k / 100.0)).norm();
        expected += length * std::numbers::pi * yarn.radius_mm * yarn.radius_mm;
    }
    CHECK(volume == Approx(expected).epsilon(0.03));
    CHECK(volume < expected);
}

TEST_CASE("nothing, and too much, is not exported") {
    CHECK_FALSE(write_vtp({}));
    CHECK_FALSE(write_obj({}));
    Yarns yarns = plain_weave();
    Spline& spline = yarns.yarns[0].spline;
    while (spline.control.size() < 200'000)
        spline.control.push_back({static_cast<double>(spline.control.size() % 7), 0, 0});
    yarns.yarns[0].strain.resize(spline.control.size());
    yarns.yarns[0].contact_N.resize(spline.control.size());
    CHECK_FALSE(write_obj(yarns));
}
