#include <weave/sim/exports.hpp>

#include <weave/sim/sampled.hpp>

#include <Eigen/Geometry>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace weave {

namespace {

constexpr double error_share = 0.01;     ///< how far a line strays from the centreline, of the radius
constexpr std::size_t least_pieces = 4;  ///< of a segment between control points
constexpr int sides = 20;

/// Left-handed cloth axes to right-handed ones: see exports.hpp.
Vec3 turned(const Vec3& place) {
    return {place.y(), place.x(), place.z()};
}

std::vector<double> line_of(const SimulatedYarn& yarn) {
    return sample_parameters(yarn.spline, error_share * yarn.radius_mm, least_pieces);
}

/// Every yarn's parameters, or the refusal that both exports share.
Result<std::vector<std::vector<double>>> lines_of(const Yarns& yarns, std::size_t around) {
    if (yarns.yarns.empty()) return invalid("there is no yarn to export");
    std::vector<std::vector<double>> lines;
    std::size_t points = 0;
    for (const SimulatedYarn& yarn : yarns.yarns) {
        lines.push_back(line_of(yarn));
        points += lines.back().size() * around;
        if (points > most_export_points) {
            return invalid("the export would have more than " + std::to_string(most_export_points) +
                           " points: simulate a smaller region");
        }
    }
    return lines;
}

// ---- VTK ----

std::string base64(const std::string& bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        const std::size_t left = std::min<std::size_t>(3, bytes.size() - at);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < left ? static_cast<std::uint8_t>(bytes[at + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text.push_back(k <= left ? digits[group >> (18 - 6 * k) & 63] : '=');
    }
    return text;
}

/// The data of one array, little-endian whatever the machine.
class DataArray {
  public:
    explicit DataArray(std::string attributes) : m_attributes(std::move(attributes)) {}
    void add(double number) { put(std::bit_cast<std::uint64_t>(number), 8); }
    void add(const Vec3& point) {
        for (int axis = 0; axis < 3; ++axis) add(point[axis]);
    }
    void add_whole(std::size_t number, int bytes) { put(number, bytes); }

    [[nodiscard]] std::string xml() const {
        DataArray size("");
        size.add_whole(m_bytes.size(), 8);
        return "<DataArray " + m_attributes + " format=\"binary\">" + base64(size.m_bytes + m_bytes) +
               "</DataArray>\n";
    }

  private:
    void put(std::uint64_t word, int bytes) {
        for (int k = 0; k < bytes; ++k) m_bytes.push_back(static_cast<char>(word >> 8 * k & 0xff));
    }
    std::string m_attributes, m_bytes;
};

struct PolyData {
    DataArray points{R"(type="Float64" Name="Points" NumberOfComponents="3")"};
    DataArray radius{R"(type="Float64" Name="radius_mm")"};
    DataArray strain{R"(type="Float64" Name="strain")"};
    DataArray contact{R"(type="Float64" Name="contact_N")"};
    DataArray yarn{R"(type="Int32" Name="yarn")"};
    DataArray system{R"(type="UInt8" Name="system")"};
    DataArray connectivity{R"(type="Int64" Name="connectivity")"};
    DataArray offsets{R"(type="Int64" Name="offsets")"};
    std::size_t count = 0;

    void add(const SimulatedYarn& of, const std::vector<double>& parameters) {
        for (const double t : parameters) {
            points.add(turned(of.spline.place(t)));
            radius.add(of.radius_mm);
            strain.add(value_at(of.spline, of.strain, t));
            contact.add(value_at(of.spline, of.contact_N, t));
            yarn.add_whole(of.number + 1, 4);
            system.add_whole(of.system == System::warp ? 1 : 0, 1);
            connectivity.add_whole(count++, 8);
        }
        offsets.add_whole(count, 8);
    }
};

// ---- OBJ ----

/// The number with six decimals, a nanometre, and no needless zeros.
void append(std::string& text, double number) {
    char buffer[340];
    const auto [end, code] =
        std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::fixed, 6);
    std::string_view digits(buffer, static_cast<std::size_t>(end - buffer));
    digits = digits.substr(0, digits.find_last_not_of('0') + 1);
    if (digits.ends_with('.')) digits.remove_suffix(1);
    text += ' ';
    text += digits == "-0" ? "0" : digits;
}

void append(std::string& text, const Vec3& vector) {
    for (int axis = 0; axis < 3; ++axis) append(text, vector[axis]);
}

/// Any direction across `along`.
Vec3 across(const Vec3& along) {
    const Vec3 axis = std::abs(along.z()) < 0.9 ? Vec3(0, 0, 1) : Vec3(1, 0, 0);
    return along.cross(axis).normalized();
}

/// Writes tubes, and counts what it has written.
class TubeWriter {
  public:
    explicit TubeWriter(std::string& text) : m_text(text) {}

    void add(const SimulatedYarn& yarn, const std::vector<double>& parameters) {
        m_text +=
            (yarn.system == System::warp ? "g end_" : "g pick_") + std::to_string(yarn.number + 1) + "\n";
        const std::size_t first = m_vertex + 1, first_normal = m_normal + 1;
        Vec3 along = direction(yarn, parameters.front(), Vec3(1, 0, 0)), side = across(along);
        const Vec3 start = along;
        for (const double t : parameters) {
            const Vec3 next = direction(yarn, t, along);
            side = carried(side, along, next);
            along = next;
            ring(yarn, turned(yarn.spline.place(t)), along, side);
        }
        for (std::size_t k = 0; k + 1 < parameters.size(); ++k)
            wall(first + k * sides, first_normal + k * sides);
        lid(-start, first, true);
        lid(along, first + (parameters.size() - 1) * sides, false);
    }

  private:
    /// The direction of the yarn, or the one before where it stands still.
    static Vec3 direction(const SimulatedYarn& yarn, double t, const Vec3& before) {
        const Vec3 tangent = turned(yarn.spline.tangent(t));
        return tangent.norm() > 0 ? Vec3(tangent.normalized()) : before;
    }

    /// `side` turned as little as the yarn turns (parallel transport), so that the tube does not twist.
    static Vec3 carried(const Vec3& side, const Vec3& from, const Vec3& to) {
        Vec3 turned_side = Eigen::Quaterniond::FromTwoVectors(from, to) * side;
        turned_side -= turned_side.dot(to) * to;
        return turned_side.norm() > 1e-6 ? Vec3(turned_side.normalized()) : across(to);
    }

    void vertex(const SimulatedYarn& yarn, const Vec3& place) {
        m_text += 'v';
        append(m_text, place);
        append(m_text, Vec3(yarn.colour.red, yarn.colour.green, yarn.colour.blue) / 255);
        m_text += '\n';
        ++m_vertex;
    }
    void normal(const Vec3& way) {
        m_text += "vn";
        append(m_text, way);
        m_text += '\n';
        ++m_normal;
    }
    void ring(const SimulatedYarn& yarn, const Vec3& centre, const Vec3& along, const Vec3& side) {
        const Vec3 up = along.cross(side);
        for (int k = 0; k < sides; ++k) {
            const double angle = 2 * std::numbers::pi * k / sides;
            const Vec3 out = std::cos(angle) * side + std::sin(angle) * up;
            vertex(yarn, centre + yarn.radius_mm * out);
            normal(out);
        }
    }
    void corner(std::size_t at, std::size_t way) {
        m_text += ' ' + std::to_string(at) + "//" + std::to_string(way);
    }
    /// The faces from one ring to the next, seen anticlockwise from outside.
    void wall(std::size_t ring_at, std::size_t normals_at) {
        for (std::size_t k = 0; k < sides; ++k) {
            const std::size_t next = (k + 1) % sides;
            m_text += 'f';
            for (const std::size_t place : {k, next, next + sides, k + sides})
                corner(ring_at + place, normals_at + place);
            m_text += '\n';
        }
    }
    void lid(const Vec3& way, std::size_t ring_at, bool backwards) {
        normal(way);
        m_text += 'f';
        for (std::size_t k = 0; k < sides; ++k) corner(ring_at + (backwards ? sides - 1 - k : k), m_normal);
        m_text += '\n';
    }

    std::string& m_text;
    std::size_t m_vertex = 0, m_normal = 0;
};

}  // namespace

Result<std::string> write_vtp(const Yarns& yarns) {
    WEAVE_TRY(const auto lines, lines_of(yarns, 1));
    PolyData data;
    for (std::size_t i = 0; i < lines.size(); ++i) data.add(yarns.yarns[i], lines[i]);
    std::string xml =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<!-- mm and N; x along the picks, y along the ends, z up -->\n"
        "<PolyData>\n<Piece NumberOfPoints=\"" +
        std::to_string(data.count) + "\" NumberOfVerts=\"0\" NumberOfLines=\"" +
        std::to_string(lines.size()) +
        "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData Scalars=\"radius_mm\">\n";
    for (const DataArray* array : {&data.radius, &data.strain, &data.contact, &data.yarn, &data.system})
        xml += array->xml();
    xml += "</PointData>\n<Points>\n" + data.points.xml() + "</Points>\n<Lines>\n" + data.connectivity.xml() +
           data.offsets.xml() + "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
    return xml;
}

Result<std::string> write_obj(const Yarns& yarns) {
    WEAVE_TRY(const auto lines, lines_of(yarns, sides));
    std::string text =
        "# Yarns as tubes. Unit: millimetre. x along the picks, y along the ends, z up (right-handed).\n"
        "# Groups: pick_N and end_N, counted from 1. Vertex colours follow the coordinates.\n";
    TubeWriter writer(text);
    for (std::size_t i = 0; i < lines.size(); ++i) writer.add(yarns.yarns[i], lines[i]);
    return text;
}

}  // namespace weave
