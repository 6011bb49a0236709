// SPDX-License-Identifier: MIT
#include "interchange/assimp/named_materials.h"

#include <algorithm>

namespace embody::interchange {
namespace {

// Name, Kd, Ns and d of Java 3D 1.5.2 (com.sun.j3d.loaders.objectfile), of the names that Sweet Home 3D's furniture
// has; rounded. Ns is 0 where no highlight is asked for (illum 0 and 1).
constexpr auto materials = std::to_array<NamedMaterial>({
    {"amber", {0.576F, 0.268F, 0.0F}, 60.0F, 1.0F},
    {"archwhite", {0.996F, 0.996F, 0.996F}, 0.0F, 1.0F},
    {"archwhite2", {0.841F, 0.841F, 0.841F}, 0.0F, 1.0F},
    {"black", {0.002F, 0.002F, 0.002F}, 157.36F, 1.0F},
    {"bluegrey", {0.188F, 0.279F, 0.29F}, 14.73F, 1.0F},
    {"bluteal", {0.078F, 0.257F, 0.204F}, 25.0F, 1.0F},
    {"bone", {0.9F, 0.763F, 0.426F}, 200.0F, 1.0F},
    {"bone2", {0.984F, 0.862F, 0.65F}, 0.0F, 1.0F},
    {"bronze", {0.065F, 0.037F, 0.012F}, 137.21F, 1.0F},
    {"brown", {0.086F, 0.015F, 0.0F}, 65.89F, 1.0F},
    {"brownlips", {0.143F, 0.065F, 0.041F}, 25.0F, 1.0F},
    {"brzskin", {0.38F, 0.29F, 0.212F}, 25.0F, 1.0F},
    {"chappie", {0.584F, 0.18F, 0.037F}, 60.0F, 1.0F},
    {"default", {0.71F, 0.702F, 0.653F}, 128.0F, 1.0F},
    {"dkblue", {0.0F, 0.004F, 0.057F}, 60.0F, 1.0F},
    {"dkdkgrey", {0.012F, 0.012F, 0.012F}, 60.0F, 1.0F},
    {"dkgrey", {0.049F, 0.049F, 0.049F}, 60.0F, 1.0F},
    {"dkred", {0.229F, 0.0F, 0.0F}, 60.0F, 1.0F},
    {"flblack", {0.004F, 0.004F, 0.004F}, 0.0F, 1.0F},
    {"flblonde", {0.571F, 0.328F, 0.044F}, 0.0F, 1.0F},
    {"flbrown", {0.11F, 0.012F, 0.001F}, 0.0F, 1.0F},
    {"fldkdkgrey", {0.012F, 0.012F, 0.012F}, 0.0F, 1.0F},
    {"fldkgrey", {0.094F, 0.094F, 0.094F}, 0.0F, 1.0F},
    {"flesh", {0.526F, 0.413F, 0.337F}, 60.0F, 1.0F},
    {"flgrey", {0.5F, 0.5F, 0.5F}, 0.0F, 1.0F},
    {"flltbrown", {0.278F, 0.114F, 0.053F}, 0.0F, 1.0F},
    {"flltgrey", {0.825F, 0.825F, 0.825F}, 0.0F, 1.0F},
    {"florange", {1.0F, 0.167F, 0.0F}, 0.0F, 1.0F},
    {"fltan", {0.661F, 0.457F, 0.13F}, 0.0F, 1.0F},
    {"flwhite", {0.984F, 0.931F, 0.839F}, 200.0F, 1.0F},
    {"flwhite1", {1.0F, 1.0F, 1.0F}, 0.0F, 1.0F},
    {"flyellow", {1.0F, 0.667F, 0.0F}, 0.0F, 1.0F},
    {"glassblutint", {0.555F, 0.8F, 0.773F}, 60.0F, 0.33F},
    {"glasstransparent", {0.469F, 0.469F, 0.469F}, 200.0F, 0.75F},
    {"gold", {1.0F, 0.49F, 0.0F}, 123.26F, 1.0F},
    {"green", {0.0F, 0.25F, 0.0F}, 65.89F, 1.0F},
    {"grey", {0.184F, 0.184F, 0.184F}, 65.89F, 1.0F},
    {"iris", {0.0F, 0.057F, 0.318F}, 188.37F, 1.0F},
    {"jetflame", {0.951F, 0.494F, 0.098F}, 132.56F, 1.0F},
    {"lavendar", {0.219F, 0.091F, 0.347F}, 60.0F, 1.0F},
    {"lcdgreen", {0.588F, 1.0F, 0.506F}, 60.0F, 1.0F},
    {"lighttan", {0.702F, 0.421F, 0.221F}, 177.52F, 1.0F},
    {"lighttan2", {0.314F, 0.187F, 0.096F}, 177.52F, 1.0F},
    {"lighttannew", {0.788F, 0.607F, 0.322F}, 177.52F, 1.0F},
    {"lime", {0.0F, 1.0F, 0.0F}, 65.89F, 1.0F},
    {"ltbrown", {0.278F, 0.114F, 0.053F}, 60.0F, 1.0F},
    {"ltgrey", {0.384F, 0.384F, 0.384F}, 65.89F, 1.0F},
    {"metal", {0.9F, 0.763F, 0.426F}, 200.0F, 1.0F},
    {"navy_blue", {0.0F, 0.0F, 0.053F}, 91.47F, 1.0F},
    {"offwhite.warm", {0.837F, 0.69F, 0.449F}, 60.0F, 1.0F},
    {"red", {0.771F, 0.0F, 0.0F}, 136.43F, 1.0F},
    {"redorange", {0.755F, 0.018F, 0.0F}, 132.56F, 1.0F},
    {"redwood", {0.257F, 0.033F, 0.0F}, 91.47F, 1.0F},
    {"ruby", {1.0F, 0.0F, 0.0F}, 60.0F, 0.75F},
    {"sand_stone", {0.126F, 0.114F, 0.097F}, 60.0F, 1.0F},
    {"ship2", {1.0F, 1.0F, 1.0F}, 60.0F, 1.0F},
    {"silver", {0.616F, 0.616F, 0.616F}, 60.0F, 1.0F},
    {"sky_blue", {0.124F, 0.593F, 0.8F}, 13.95F, 1.0F},
    {"tan", {0.661F, 0.522F, 0.219F}, 60.0F, 1.0F},
    {"teeth", {0.984F, 0.796F, 0.469F}, 0.0F, 1.0F},
    {"white", {1.0F, 1.0F, 1.0F}, 60.0F, 1.0F},
    {"yellow", {1.0F, 0.667F, 0.0F}, 65.89F, 1.0F},
    {"yellow_green", {0.188F, 0.408F, 0.002F}, 91.47F, 1.0F},
    {"yellowbrt", {1.0F, 0.784F, 0.0F}, 60.0F, 1.0F},
    {"yelloworng", {0.886F, 0.249F, 0.0F}, 60.0F, 1.0F},
});
static_assert(std::ranges::is_sorted(materials, {}, &NamedMaterial::name));

}  // namespace

const NamedMaterial* named_material(std::string_view name) {
    const auto at = std::ranges::lower_bound(materials, name, {}, &NamedMaterial::name);
    return at != materials.end() && at->name == name ? &*at : nullptr;
}

}  // namespace embody::interchange
