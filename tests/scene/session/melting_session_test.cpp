// SPDX-License-Identifier: MIT
// What melts in a session: time goes back to before and after, *Keep* and undo, reset.
#include "scene/simulation/melting.h"

namespace embody::scene {
namespace {

using namespace samples;

class MeltingSession : public LiveSession {
protected:
    void begin(EntityIndex into) {
        Document document = tub();
        water_ = add_water(document, 0.08, false, 2000).index;
        thing_ = samples::add(document, "Ice", physics::BoxShape{{0.05, 0.05, 0.05}}, {0, 0.2, 0}).index;
        document.actions = {{.id = 1,
                             .receiver = {Target::By::index, thing_, {}},
                             .trigger = AtTime{0.5, {}},
                             .effect = Melt{into != 0 ? water_ : 0}}};
        open(document);
        drops_ = drops();
        run("simulation.step", {{"count", 60}});
    }
    std::size_t drops() {
        std::vector<Vec3> places;
        const ShownPoints* points = state(water_).points;
        if (points != nullptr) points->read(places);
        return places.size();
    }
    bool is_there(EntityIndex index) { return state(index).entity == index; }
    std::size_t entities() {
        std::vector<EntityState> states;
        session_->read_states(states);
        return states.size();
    }

    EntityIndex water_ = 0, thing_ = 0;
    std::size_t drops_ = 0;  // of the water at the start
};

TEST_F(MeltingSession, GoesBackToBeforeAndAfterAndIsReset) {
    for (const EntityIndex into : {0u, 1u}) {
        begin(into);
        EXPECT_FALSE(is_there(thing_));
        const std::size_t melted = drops(), there = entities();
        EXPECT_EQ(melted > drops_, into != 0);
        run("time.seek", {{"time", 0.8}});
        run("time.branch");
        EXPECT_FALSE(is_there(thing_));
        EXPECT_EQ(drops(), melted);
        EXPECT_EQ(entities(), there);
        run("simulation.step", {{"count", 5}});
        run("time.seek", {{"time", 0.3}});
        run("time.branch");
        EXPECT_TRUE(is_there(thing_));
        EXPECT_EQ(drops(), drops_);
        run("simulation.step", {{"count", 30}});
        EXPECT_FALSE(is_there(thing_));
        run("simulation.reset");
        EXPECT_TRUE(is_there(thing_));
        EXPECT_EQ(drops(), drops_);
    }
}

// What melted into a liquid is kept with it, and not once more as the thing.
TEST_F(MeltingSession, KeepsWhatMeltedOnce) {
    begin(1);
    const std::size_t melted = drops();
    run("simulation.keep");
    EXPECT_FALSE(session_->document().find(thing_)->enabled);
    EXPECT_EQ(drops(), melted);
    run("edit.undo");
    EXPECT_TRUE(session_->document().find(thing_)->enabled);
    EXPECT_EQ(drops(), drops_);

    begin(0);
    run("simulation.keep");
    EXPECT_TRUE(session_->document().find(thing_)->enabled);
    EXPECT_TRUE(is_there(thing_));
}

}  // namespace
}  // namespace embody::scene
