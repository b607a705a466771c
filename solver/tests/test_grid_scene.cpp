// Scenes of the fluid on a grid.
#include "core/errors.hpp"
#include "schemes/simulation.hpp"

#include "checkpoint_scenes.hpp"
#include "fluid_fixtures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace plumb {
namespace {

using fixture::checkpoint_scenes::grains_on_grid;
using fixture::checkpoint_scenes::on_grid;

/// A scene with one text in place of another.
std::string changed(const std::string& from, const std::string& to, std::string text = on_grid) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

Simulation simulation(const std::string& text) {
    Scene scene = scene_from_text(text, "scene.toml", "/");
    return make_simulation(scene);
}

void expect_refused(const std::string& text, const std::vector<std::string>& parts) {
    try {
        simulation(text);
        ADD_FAILURE() << "no error";
    } catch (const InputError& e) {
        for (const std::string& part : parts) EXPECT_THAT(e.what(), testing::HasSubstr(part));
    }
}

TEST(GridScene, WhatCannotBeMeantIsRefused) {
    expect_refused(changed("spacing = 0.0625", "spacing = 0.06"), {"fluid.spacing", "whole number"});
    expect_refused(changed("spacing = 0.0625", "spacing = [0.0625]"), {"fluid.spacing"});
    expect_refused(changed("spacing = 0.0625", "spacing = 0.0625\nstretch_x = {at = [0.0, 1.0], times = [1.0, 2.0]}"),
                   {"stretch_x.at", "from 0 to 2"});
    expect_refused(changed("spacing = 0.0625", "spacing = 0.0625\nstretch_x = {at = [0.0, 2.0], times = [1.0]}"),
                   {"stretch_x.times"});
    expect_refused(changed("spacing = 0.0625", "spacing = 0.0625\nstretch_x = {at = [0.0, 2.0], times = [1e-9, 1e-9]}"),
                   {"stretch_x.times", "cells"});
    expect_refused(changed("viscosity = 0.02", "viscosity = 0.0"), {"fluid.viscosity"});
    expect_refused(changed("\"central\"", "\"quick\""), {"fluid.advection", "quick", "upwind"});
    expect_refused(changed("point = [2.0, 0.5]", "point = [1.9, 0.5]"), {"outlet", "point", "no side"});
    expect_refused(changed("normal = [0.0, -1.0]", "normal = [0.0, 1.0]"), {"upper end of y"});
    expect_refused(changed("point = [0.0, 1.0]", "point = [0.0, 0.0]"), {"upper end of y"});
    expect_refused(changed("periodic = [false, false]", "periodic = [true, false]"), {"point", "periodic"});
    expect_refused(changed("slip = \"no_slip\"\n[time]", "slip = \"free_slip\"\n[time]"), {"immersed", "cylinder"});
    const std::string medium = "porosity = {law = \"uniform\", value = 0.5}\n";
    expect_refused(changed("viscosity", medium + "viscosity"), {"fluid.resistance"});
    expect_refused(changed("viscosity", medium + "resistance = {law = \"darcy\", permeability = 0.0}\nviscosity"),
                   {"fluid.resistance.permeability"});
    expect_refused(changed("viscosity", medium + "resistance = {law = \"none\"}\nviscosity", grains_on_grid),
                   {"fluid.porosity", "grains"});
    expect_refused(changed("integrator = \"bdf2\"", "integrator = \"midpoint\""),
                   {"time.integrator", "implicit_euler"});
}

TEST(GridScene, GrainsAreNotInjectedFasterThanTheFluidSteps) {
    EXPECT_NO_THROW(simulation(changed("interval = 0.01", "interval = 5e-4", grains_on_grid)));
    expect_refused(changed("interval = 0.01", "interval = 2.5e-4", grains_on_grid), {"injector[0].interval", "step"});
    expect_refused(changed("[[outlet]]\nname = \"bottom\"\npoint = [0.003, 0.0, 0.001]\nnormal = [0.0, 1.0, 0.0]\n"
                           "pressure = 0.0",
                           "[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0.0, 0.0, 0.0]\n"
                           "normal = [0.0, 1.0, 0.0]\nslip = \"no_slip\"\ncontact = \"as_grains\"",
                           grains_on_grid),
                   {"injector", "outlet"});
}

/// Sum over a side of the box of speed times open area, along the axis [m3/s].
double flux(const GridFluid& f, std::size_t c, int face) {
    double sum = 0.0;
    for_each_place(f.grid.faces(c), [&](const Place& p, std::size_t k) {
        if (p[c] == face) sum += f.u[c][k] * open_area(f, c, p);
    });
    return sum;
}

// What comes in goes out, across every column of the grid.
TEST(GridScene, InflowLeavesThroughTheOutlet) {
    Simulation s = simulation(on_grid);
    advance(s, 5);
    const double in = flux(*s.grid, 0, 0);
    EXPECT_NEAR(in, 1.0, 3e-3);
    for (int face = 1; face <= 32; ++face) EXPECT_NEAR(flux(*s.grid, 0, face), in, 1e-6);
}

// Without the cylinder a developed profile stays and the pressure falls by 12 mu U/H^2 per length: exact on a grid but
// for the half cell at the walls, (h/H)^2 of the peak.
TEST(GridScene, DevelopedFlowKeepsItsPressure) {
    const std::string text = changed("law = \"uniform\", velocity = [1.0, 0.0]",
                                     "law = \"channel\", mean_speed = 1.0, centre = 0.5, half_width = 0.5",
                                     changed("radius = 0.2\n", "radius = 1e-9\n"));
    Simulation s = simulation(text);
    advance(s, 40);
    const GridFluid& f = *s.grid;
    const Block cells = f.grid.cells();
    const double drop = (f.p[cells.at({8, 8, 0})] - f.p[cells.at({24, 8, 0})]) / 1.0, exact = 12.0 * 0.02;
    EXPECT_NEAR(drop, exact, 0.02 * exact);
    EXPECT_NEAR(f.p[cells.at({31, 8, 0})], 3.0 + 0.03125 * exact, 0.02 * exact);
}

} // namespace
} // namespace plumb
