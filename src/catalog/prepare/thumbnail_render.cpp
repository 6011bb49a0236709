// SPDX-License-Identifier: MIT
// I. Wald et al., "Embree: a kernel framework for efficient CPU ray tracing", 2014, casts the rays.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "catalog/prepare/thumbnail.h"
#include "foundation/random.h"
#include "interchange/image/image_codec.h"
#include "math/bounds.h"

namespace embody::catalog {
namespace {

using interchange::Image;
using interchange::RawMaterial;
using interchange::RawMesh;
using interchange::RawScene;

constexpr int samples_a_side = 3;    // rays a pixel: 9
constexpr double view_angle = 0.35;  // half of the field of view, rad
constexpr int max_layers = 8;        // transparent surfaces looked through
const Vec3 toward_viewer = normalized(Vec3{0.55, 0.45, 0.9});
const Vec3 toward_sun = normalized(Vec3{0.35, 0.85, 0.6});
constexpr double sun = 0.5, sky = 0.45, ground = 0.22;  // light, linear

double srgb_from_linear(double v) {
    v = std::clamp(v, 0.0, 1.0);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}
/// A fraction 0 … 1 as a byte.
std::uint8_t byte_from(double fraction) { return static_cast<std::uint8_t>(std::lround(255 * fraction)); }
double linear_from_srgb(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

/// The hit of a ray: place, normal and material there.
struct SurfacePoint {
    Vec3 position, normal;
    Vec3 color;  ///< linear
    double alpha = 1;
};

struct ViewRay {
    Vec3 origin, direction;
};

/// The scene as Embree holds it, freed at the end.
class TracedScene {
public:
    explicit TracedScene(const RawScene& scene) : scene_(scene) {
        // One thread, which is this one: the worker may start no others.
        device_ = rtcNewDevice("threads=1,set_affinity=0,start_threads=0");
        if (device_ == nullptr) return;
        traced_ = rtcNewScene(device_);
        for (const RawMesh& mesh : scene.meshes) add(mesh);
        rtcCommitScene(traced_);
        for (const auto& image : scene.images) {
            auto decoded = interchange::decode_image(image.bytes);
            images_.push_back(decoded ? std::move(*decoded) : Image{});
        }
    }
    ~TracedScene() {
        if (traced_ != nullptr) rtcReleaseScene(traced_);
        if (device_ != nullptr) rtcReleaseDevice(device_);
    }
    TracedScene(const TracedScene&) = delete;
    TracedScene& operator=(const TracedScene&) = delete;

    [[nodiscard]] bool usable() const { return traced_ != nullptr && rtcGetDeviceError(device_) == RTC_ERROR_NONE; }

    /// The first surface along the ray; false where there is none.
    bool hit(Vec3 origin, Vec3 direction, SurfacePoint& point) const {
        RTCRayHit ray = ray_of(origin, direction);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcIntersect1(traced_, &context, &ray);
        if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
        point = surface(ray);
        // The side that is seen.
        if (dot(point.normal, direction) > 0) point.normal = -point.normal;
        return true;
    }

    [[nodiscard]] bool is_blocked(Vec3 origin, Vec3 direction) const {
        RTCRayHit ray = ray_of(origin, direction);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        rtcOccluded1(traced_, &context, &ray.ray);
        return ray.ray.tfar < 0;
    }

private:
    void add(const RawMesh& mesh) {
        RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                                  mesh.positions.size());
        void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                  sizeof mesh.triangles[0], mesh.triangles.size());
        if (positions != nullptr && triangles != nullptr) {
            std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Vec3f*>(positions));
            std::copy(mesh.triangles.begin(), mesh.triangles.end(),
                      static_cast<std::array<std::uint32_t, 3>*>(triangles));
            rtcCommitGeometry(geometry);
        }
        rtcAttachGeometry(traced_, geometry);
        rtcReleaseGeometry(geometry);
    }

    static RTCRayHit ray_of(Vec3 origin, Vec3 direction) {
        RTCRayHit ray{};
        const Vec3f o = to_vec3f(origin), d = to_vec3f(direction);
        ray.ray.org_x = o.x, ray.ray.org_y = o.y, ray.ray.org_z = o.z;
        ray.ray.dir_x = d.x, ray.ray.dir_y = d.y, ray.ray.dir_z = d.z;
        ray.ray.tfar = std::numeric_limits<float>::infinity();
        ray.ray.mask = ~0u;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        return ray;
    }

    SurfacePoint surface(const RTCRayHit& ray) const {
        const RawMesh& mesh = scene_.meshes[ray.hit.geomID];
        const auto& t = mesh.triangles[ray.hit.primID];
        const double u = static_cast<double>(ray.hit.u), v = static_cast<double>(ray.hit.v), w = 1 - u - v;
        SurfacePoint point;
        point.position =
            w * to_vec3(mesh.positions[t[0]]) + u * to_vec3(mesh.positions[t[1]]) + v * to_vec3(mesh.positions[t[2]]);
        point.normal = normalized(
            w * to_vec3(mesh.normals[t[0]]) + u * to_vec3(mesh.normals[t[1]]) + v * to_vec3(mesh.normals[t[2]]),
            {0, 1, 0});

        static const RawMaterial plain;
        const RawMaterial& material =
            mesh.material < 0 ? plain : scene_.materials[static_cast<std::size_t>(mesh.material)];
        const auto& base = material.base_color;
        point.color = {static_cast<double>(base[0]), static_cast<double>(base[1]), static_cast<double>(base[2])};
        point.alpha = static_cast<double>(base[3]);
        if (material.base_color_image >= 0 && !mesh.texture_coordinates.empty()) {
            const auto &a = mesh.texture_coordinates[t[0]], &b = mesh.texture_coordinates[t[1]],
                       &c = mesh.texture_coordinates[t[2]];
            const auto at = [&](std::size_t k) {
                return w * static_cast<double>(a[k]) + u * static_cast<double>(b[k]) + v * static_cast<double>(c[k]);
            };
            apply_texture(images_[static_cast<std::size_t>(material.base_color_image)], at(0), at(1), point);
        }
        return point;
    }

    /// Nearest pixel, repeated beyond the edges.
    static void apply_texture(const Image& image, double u, double v, SurfacePoint& point) {
        if (image.rgba.empty() || !std::isfinite(u) || !std::isfinite(v)) return;
        const auto pixel = [](double coordinate, int count) {
            return std::min(static_cast<int>((coordinate - std::floor(coordinate)) * count), count - 1);
        };
        const auto at = 4 * (static_cast<std::size_t>(pixel(v, image.height)) * static_cast<std::size_t>(image.width) +
                             static_cast<std::size_t>(pixel(u, image.width)));
        const auto channel = [&](std::size_t k) { return image.rgba[at + k] / 255.0; };
        point.color = scale(point.color,
                            {linear_from_srgb(channel(0)), linear_from_srgb(channel(1)), linear_from_srgb(channel(2))});
        point.alpha *= channel(3);
    }

    const RawScene& scene_;
    RTCDevice device_ = nullptr;
    RTCScene traced_ = nullptr;
    std::vector<Image> images_;
};

/// A direction of the hemisphere around `normal`, cosine-weighted: a point on the sphere that touches the surface.
Vec3 diffuse_direction(Vec3 normal, Random& random) {
    const double z = random.between(-1, 1), angle = random.between(0, 2 * 3.14159265358979323846),
                 r = std::sqrt(1 - z * z);
    return normalized(normal + Vec3{r * std::cos(angle), r * std::sin(angle), z}, normal);
}

/// Light that a surface point sends back: a sun with shadow, and a sky (one ray) brighter above than below.
Vec3 shaded(const TracedScene& traced, const SurfacePoint& point, double step, Random& random) {
    const Vec3 origin = point.position + point.normal * step;
    double light = 0;
    const double toward = dot(point.normal, toward_sun);
    if (toward > 0 && !traced.is_blocked(origin, toward_sun)) light += sun * toward;
    const Vec3 direction = diffuse_direction(point.normal, random);
    const double from_there = ground + (sky - ground) * (0.5 + 0.5 * direction.y);
    light += traced.is_blocked(origin, direction) ? 0.35 * from_there : 1.15 * from_there;
    return point.color * light;
}

/// Colour (premultiplied) and coverage seen along one ray, through transparent layers.
std::array<double, 4> seen_along(const TracedScene& traced, ViewRay ray, double step, Random& random) {
    std::array<double, 4> seen{};
    double open = 1;
    for (int layer = 0; layer < max_layers && open > 0.02; ++layer) {
        SurfacePoint point;
        if (!traced.hit(ray.origin, ray.direction, point)) break;
        const Vec3 color = shaded(traced, point, step, random) * (open * point.alpha);
        seen[0] += color.x, seen[1] += color.y, seen[2] += color.z, seen[3] += open * point.alpha;
        open *= 1 - point.alpha;
        ray.origin = point.position + ray.direction * step;
    }
    return seen;
}

Bounds bounds_of(const RawScene& scene) {
    Bounds bounds;
    for (const RawMesh& mesh : scene.meshes) {
        for (const Vec3f p : mesh.positions) bounds.add(to_vec3(p));
    }
    return bounds;
}

/// A camera that just sees all vertices.
class Camera {
public:
    explicit Camera(const RawScene& scene) {
        const Bounds bounds = bounds_of(scene);
        right_ = normalized(cross({0, 1, 0}, toward_viewer));
        up_ = cross(toward_viewer, right_);
        // Far enough back for each vertex to lie within the view's pyramid.
        const Vec3 c = bounds.center();
        double distance = 0;
        for (const RawMesh& mesh : scene.meshes) {
            for (const Vec3f p : mesh.positions) {
                const Vec3 d = to_vec3(p) - c;
                const double aside = std::max(std::fabs(dot(d, right_)), std::fabs(dot(d, up_)));
                distance = std::max(distance, dot(d, toward_viewer) + aside / std::tan(view_angle));
            }
        }
        origin_ = c + toward_viewer * (1.06 * distance);
    }

    /// `x`, `y` in 0 … 1 from the upper left.
    [[nodiscard]] ViewRay ray(double x, double y) const {
        const double t = std::tan(view_angle);
        return {origin_, normalized(right_ * ((2 * x - 1) * t) + up_ * ((1 - 2 * y) * t) - toward_viewer)};
    }

private:
    Vec3 origin_, right_, up_;
};

}  // namespace

std::vector<std::uint8_t> render_thumbnail(const RawScene& scene) {
    const TracedScene traced(scene);
    Image image{thumbnail_size, thumbnail_size,
                std::vector<std::uint8_t>(std::size_t{4} * thumbnail_size * thumbnail_size)};
    if (!traced.usable()) return interchange::encode_png(image);
    const Camera camera(scene);
    const double step = 1e-4 * length(bounds_of(scene).size());
    Random random(1);

    constexpr int samples = samples_a_side * samples_a_side;
    for (int row = 0; row < thumbnail_size; ++row) {
        for (int column = 0; column < thumbnail_size; ++column) {
            std::array<double, 4> sum{};
            for (int s = 0; s < samples; ++s) {
                const int across = s % samples_a_side, down = s / samples_a_side;
                const double x = (column + (across + 0.5) / samples_a_side) / thumbnail_size;
                const double y = (row + (down + 0.5) / samples_a_side) / thumbnail_size;
                const auto seen = seen_along(traced, camera.ray(x, y), step, random);
                for (std::size_t k = 0; k < 4; ++k) sum[k] += seen[k];
            }
            if (sum[3] <= 0) continue;
            std::uint8_t* pixel = &image.rgba[4 * static_cast<std::size_t>(row * thumbnail_size + column)];
            for (std::size_t k = 0; k < 3; ++k) pixel[k] = byte_from(srgb_from_linear(sum[k] / sum[3]));
            pixel[3] = byte_from(std::min(1.0, sum[3] / samples));
        }
    }
    return interchange::encode_png(image);
}

}  // namespace embody::catalog
