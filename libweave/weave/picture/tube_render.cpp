#include <weave/picture/tube_render.hpp>

#include <weave/picture/colour_map.hpp>
#include <weave/picture/tube_shade.hpp>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>
#include <thread>

namespace weave {

namespace {

constexpr std::size_t band_rows = 16, samples = 4;
/// Where the rays of a pixel go through it: no two in one row or column.
constexpr Point sample_places[samples]{{0.375, 0.125}, {0.875, 0.375}, {0.125, 0.625}, {0.625, 0.875}};
constexpr std::uint32_t nothing = std::numeric_limits<std::uint32_t>::max();

/// What a ray sees.
struct Seen {
    double distance = std::numeric_limits<double>::infinity();
    std::uint32_t piece = nothing;
    bool is_flat = false;  ///< a cut through the yarn, not its round side
};

/// A piece as it lies on the screen.
struct Outline {
    float left, right, top, bottom;  ///< pixels
    double nearest;                  ///< no ray meets it before this distance
};

class Renderer {
  public:
    Renderer(const TubeScene& scene, const TubeCamera& camera, std::size_t width, std::size_t height)
        : m_scene(scene),
          m_camera(camera),
          m_width(width),
          m_height(height),
          m_occlusion(scene),
          m_pixels(width * height, 0xffffff) {
        for (const Colour colour : scene.colours) m_lights.push_back(to_light(colour));
        sort_pieces();
    }

    std::vector<std::uint32_t> run() {
        std::atomic<std::size_t> next{0};
        const auto work = [&] {
            std::vector<Seen> seen;
            for (std::size_t band = next++; band < m_bands.size(); band = next++) draw_band(band, seen);
        };
        const unsigned count = std::clamp(std::thread::hardware_concurrency(), 1U, 16U);
        std::vector<std::jthread> threads;
        for (unsigned k = 1; k < count; ++k) threads.emplace_back(work);
        work();
        threads.clear();  // waits for all
        return std::move(m_pixels);
    }

  private:
    Outline outline_of(const TubePiece& piece) const {
        const Rectangle a = m_camera.on_screen(m_camera.box_of(piece.from, piece.radius)),
                        b = m_camera.on_screen(m_camera.box_of(piece.to, piece.radius));
        // By distance along the ray, which with perspective is not less than depth.
        const double nearest = std::min(piece.from.z(), piece.to.z()) - piece.radius;
        return {static_cast<float>(std::min(a.x, b.x)),
                static_cast<float>(std::max(a.x + a.width, b.x + b.width)),
                static_cast<float>(std::min(a.y, b.y)),
                static_cast<float>(std::max(a.y + a.height, b.y + b.height)), nearest};
    }

    /// Tells every band of rows which pieces it may show, the nearest first: most of the others then lie
    /// behind what was drawn, which is quickly seen.
    void sort_pieces() {
        m_outlines.reserve(m_scene.pieces.size());
        for (const TubePiece& piece : m_scene.pieces) m_outlines.push_back(outline_of(piece));
        std::vector<std::uint32_t> order(m_outlines.size());
        std::iota(order.begin(), order.end(), 0U);
        std::ranges::sort(order, [this](std::uint32_t a, std::uint32_t b) {
            return std::pair(m_outlines[a].nearest, a) < std::pair(m_outlines[b].nearest, b);
        });
        m_bands.resize((m_height + band_rows - 1) / band_rows);
        for (const std::uint32_t piece : order) {
            const auto [top, bottom] = span(m_outlines[piece].top, m_outlines[piece].bottom, m_height);
            if (top >= bottom) continue;
            for (std::size_t band = top / band_rows; band <= (bottom - 1) / band_rows; ++band)
                m_bands[band].push_back(piece);
        }
    }

    /// The whole pixels from `low` to `high`, the last one left out.
    static std::pair<std::size_t, std::size_t> span(float low, float high, std::size_t most) {
        const auto end = static_cast<float>(most);
        return {static_cast<std::size_t>(std::clamp(std::floor(low), 0.0F, end)),
                static_cast<std::size_t>(std::clamp(std::ceil(high), 0.0F, end))};
    }

    void draw_band(std::size_t band, std::vector<Seen>& seen) {
        const std::size_t first = band * band_rows, last = std::min(first + band_rows, m_height);
        seen.assign((last - first) * m_width * samples, Seen{});
        for (const std::uint32_t piece : m_bands[band]) look_at(piece, first, last, seen);
        for (std::size_t y = first; y < last; ++y) {
            for (std::size_t x = 0; x < m_width; ++x)
                m_pixels[y * m_width + x] = colour_of(&seen[((y - first) * m_width + x) * samples], x, y);
        }
    }

    void look_at(std::uint32_t piece, std::size_t first, std::size_t last, std::vector<Seen>& seen) const {
        const Outline& outline = m_outlines[piece];
        const auto [top, bottom] = span(outline.top, outline.bottom, m_height);
        const auto [left, right] = span(outline.left, outline.right, m_width);
        for (std::size_t y = std::max(top, first); y < std::min(bottom, last); ++y) {
            Seen* at = &seen[((y - first) * m_width + left) * samples];
            for (std::size_t x = left; x < right; ++x) {
                for (std::size_t k = 0; k < samples; ++k, ++at) {
                    if (at->distance >= outline.nearest) see(piece, ray_of(x, y, k), *at);
                }
            }
        }
    }

    [[nodiscard]] Ray ray_of(std::size_t x, std::size_t y, std::size_t sample) const {
        return m_camera.ray(static_cast<double>(x) + sample_places[sample].x,
                            static_cast<double>(y) + sample_places[sample].y);
    }

    /// Whether `piece` is the nearest so far on this ray.
    void see(std::uint32_t number, const Ray& ray, Seen& seen) const {
        const TubePiece& piece = m_scene.pieces[number];
        Stretch stretch = within(piece, ray);
        if (stretch.is_empty()) return;
        bool is_flat = false;
        const auto keep = [&](const Plane& plane) {
            const Stretch kept = behind(plane, ray);
            if (kept.from > stretch.from) {
                stretch.from = kept.from;
                is_flat = true;
            }
            stretch.to = std::min(stretch.to, kept.to);
        };
        if (piece.plane_from != TubePiece::round) keep(m_scene.planes[piece.plane_from]);
        if (piece.plane_to != TubePiece::round) keep(m_scene.planes[piece.plane_to]);
        if (m_scene.cut) keep(*m_scene.cut);
        if (stretch.is_empty() || stretch.from > seen.distance) return;
        if (stretch.from == seen.distance && !is_deeper(number, seen.piece, ray, stretch.from)) return;
        seen = {stretch.from, number, is_flat};
    }

    /// Whether a place on a ray lies deeper in one yarn than in another, which a cut shows where yarns
    /// overlap.
    [[nodiscard]] bool is_deeper(std::uint32_t piece, std::uint32_t other, const Ray& ray,
                                 double distance) const {
        if (other == nothing) return true;
        const Vec3 place = ray.origin + distance * ray.way;
        const auto depth = [&](std::uint32_t of) {
            return (place - nearest_on_axis(m_scene.pieces[of], place)).norm() / m_scene.pieces[of].radius;
        };
        return std::pair(depth(piece), piece) < std::pair(depth(other), other);
    }

    /// The mean of what the rays of a pixel see.
    [[nodiscard]] std::uint32_t colour_of(const Seen* seen, std::size_t x, std::size_t y) const {
        Light sum = Light::Zero();
        std::array<std::pair<std::uint32_t, float>, samples> hidden{};  // of yarns met in this pixel
        std::size_t yarns = 0;
        bool is_empty = true;
        for (std::size_t k = 0; k < samples; ++k) {
            if (seen[k].piece == nothing) {
                sum += Light::Ones();
                continue;
            }
            is_empty = false;
            const Ray ray = ray_of(x, y, k);
            const Vec3 place = ray.origin + seen[k].distance * ray.way;
            const TubePiece& piece = m_scene.pieces[seen[k].piece];
            if (seen[k].is_flat) {
                sum += flat_light(piece, place);
                continue;
            }
            const Vec3 normal = normal_at(piece, place);
            std::size_t found = 0;
            while (found < yarns && hidden[found].first != piece.yarn) ++found;
            if (found == yarns) hidden[yarns++] = {piece.yarn, m_occlusion.hidden(place, normal)};
            sum += shaded(light_of(piece, place), normal, ray.way, hidden[found].second, m_lights.empty());
        }
        return is_empty ? 0xffffff : to_pixel(sum / static_cast<float>(samples));
    }

    /// Across the yarn's own direction, which changes evenly along a piece, so that no joints show.
    static Vec3 normal_at(const TubePiece& piece, const Vec3& place) {
        const double share = share_along(piece, place);
        const Vec3 from = piece.tangent_from.cast<double>(), to = piece.tangent_to.cast<double>();
        const Vec3 tangent = (from + share * (to - from)).normalized();
        const Vec3 out = place - nearest_on_axis(piece, place), across = out - out.dot(tangent) * tangent;
        return across.squaredNorm() > 0.01 * piece.radius * piece.radius ? Vec3(across.normalized())
                                                                         : Vec3(out.normalized());
    }

    [[nodiscard]] Light light_of(const TubePiece& piece, const Vec3& place) const {
        if (!m_lights.empty()) return m_lights[piece.yarn];
        const double value =
            piece.value_from + share_along(piece, place) * double{piece.value_to - piece.value_from};
        return to_light(map_colour((value - m_scene.low) / (m_scene.high - m_scene.low)));
    }

    /// A cut through a yarn: its colour, a little lighter, with a dark rim that parts it from the next.
    [[nodiscard]] Light flat_light(const TubePiece& piece, const Vec3& place) const {
        const Light colour = light_of(piece, place);
        const double out = (place - nearest_on_axis(piece, place)).norm() / piece.radius;
        return out > 0.9 ? Light(colour * 0.35F) : Light(colour + (Light::Ones() - colour) * 0.22F);
    }

    const TubeScene& m_scene;
    const TubeCamera& m_camera;
    std::size_t m_width, m_height;
    Occlusion m_occlusion;
    std::vector<std::uint32_t> m_pixels;
    std::vector<Light> m_lights;
    std::vector<Outline> m_outlines;
    std::vector<std::vector<std::uint32_t>> m_bands;
};

}  // namespace

std::vector<std::uint32_t> render(const TubeScene& scene, const TubeCamera& camera, std::size_t width,
                                  std::size_t height) {
    return Renderer(scene, camera, width, height).run();
}

}  // namespace weave
