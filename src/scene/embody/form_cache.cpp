// SPDX-License-Identifier: MIT
#include "scene/embody/form_cache.h"

namespace embody::scene {

namespace {

constexpr std::size_t max_kept = 256;

template <class Forms>
void keep_primitives(Forms& forms) {
    std::erase_if(forms, [](const auto& item) { return item.first.of != GeometryKey::Of::primitive; });
    if (forms.size() > max_kept) forms.clear();
}

}  // namespace

void FormCache::begin() {
    keep_primitives(soft_meshes);
    keep_primitives(thin_forms);
}

}  // namespace embody::scene
