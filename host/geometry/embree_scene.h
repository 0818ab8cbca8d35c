#pragma once

#include "host/geometry/embree_version.h"
#include "host/geometry/surfaces.h"

#include <atomic>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace reradiant {

/// The surfaces of a scene as Embree holds them. Throws a run-time Error where Embree fails.
class EmbreeScene {
public:
    /// `surfaces` must outlive this, at the same place.
    explicit EmbreeScene(const Surfaces& surfaces);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    RTCScene scene() const { return scene_; }
    /// What a geometry was made of: one of the members of Surfaces, or an OwnedMesh of its meshes.
    const void* source(unsigned int geometry, unsigned int instance) const;
    std::size_t triangles() const { return triangles_; } ///< those of each instance counted
    std::ptrdiff_t bytes() const { return bytes_; }      ///< as Embree reports it
    const std::string& version() const { return version_; }

private:
    template <typename Primitive>
    void attach(const OwnedPrimitives<Primitive>& owned);
    void attach(const OwnedMesh& mesh);
    /// Returns a mesh for Embree, not yet attached to a scene.
    RTCGeometry triangles_of(const MeshShape& mesh) const;
    /// Returns the scene that holds a mesh for its instances.
    RTCScene shared_scene(const MeshShape& mesh);
    void check(const char* doing) const;

    std::map<const MeshShape*, RTCScene> shared_scenes_;
    std::vector<const void*> sources_; ///< by Embree's geometry number
    std::atomic<std::ptrdiff_t> bytes_{0};
    std::size_t triangles_ = 0;
    std::string version_;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

} // namespace reradiant
