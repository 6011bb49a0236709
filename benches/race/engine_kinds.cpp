// SPDX-License-Identifier: MIT
#include "benches/peers/peers.h"
#include "benches/race/engine.h"

namespace embody::race {

const std::vector<EngineKind>& engine_kinds() {
    static const std::vector<EngineKind> kinds = {
        {"embody", make_embody_engine},
#ifdef EMBODY_RACE_BULLET
        {"bullet", make_bullet_engine},
#endif
#ifdef EMBODY_RACE_ODE
        {"ode", make_ode_engine},
#endif
#ifdef EMBODY_RACE_BOX3D
        {"box3d", make_box3d_engine},
#endif
#ifdef EMBODY_RACE_JOLT
        {"jolt", make_jolt_engine},
#endif
#ifdef EMBODY_RACE_PHYSX
        {"physx-pgs", make_physx_pgs_engine},
        {"physx-tgs", make_physx_tgs_engine},
#endif
    };
    return kinds;
}

}  // namespace embody::race
