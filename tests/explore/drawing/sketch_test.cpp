// Tests of drawing by hand.
#include "vpe/explore/drawing/sketch.h"

#include <gtest/gtest.h>

namespace vpe::explore {
namespace {

TEST(Sketch, ClicksPlaceVerticesAndEnterEnds) {
  Drawings drawings;
  Sketch sketch(drawings);
  EXPECT_NE(sketch.click({0, 0}), "");
  sketch.choose(DrawingKind::kPolygon);
  EXPECT_EQ(sketch.finish(), "nothing is being drawn");
  ASSERT_EQ(sketch.click({0, 0}), "");
  ASSERT_EQ(sketch.click({10, 0}), "");
  EXPECT_EQ(sketch.finish(), "a polygon has at least 3 vertices, not 2");
  EXPECT_EQ(sketch.unfinished().size(), 2U);
  ASSERT_TRUE(sketch.unfinished_drawing());
  EXPECT_EQ(sketch.unfinished_drawing()->kind, DrawingKind::kLine);
  EXPECT_NE(sketch.click({-170, 0}).find("opposite"), std::string::npos);
  ASSERT_EQ(sketch.click({370, 10}), "");
  EXPECT_EQ(sketch.finish(), "");
  ASSERT_EQ(drawings.size(), 1U);
  EXPECT_EQ(drawings.all()[0]->vertices.size(), 3U);
  EXPECT_EQ(drawings.all()[0]->vertices[2].lon_deg, 10);
  EXPECT_EQ(sketch.selected(), drawings.all()[0]->id);
  EXPECT_EQ(sketch.tool(), DrawingKind::kPolygon);  // for the next one
  EXPECT_TRUE(sketch.unfinished().empty());
}

TEST(Sketch, PointsAreFinishedAtOnce) {
  Drawings drawings;
  Sketch sketch(drawings);
  sketch.choose(DrawingKind::kPoint);
  sketch.set_colour({1, 2, 3});
  ASSERT_EQ(sketch.click({5, 5}), "");
  EXPECT_NE(sketch.click({5, 95}), "");
  EXPECT_EQ(drawings.size(), 1U);
  EXPECT_EQ(drawings.all()[0]->colour, (base::Rgb{1, 2, 3}));
}

TEST(Sketch, VerticesAreTakenBackAndPlacedAgain) {
  Drawings drawings;
  Sketch sketch(drawings);
  EXPECT_FALSE(sketch.take_back());
  sketch.choose(DrawingKind::kLine);
  ASSERT_EQ(sketch.click({0, 0}), "");
  ASSERT_EQ(sketch.click({1, 0}), "");
  EXPECT_TRUE(sketch.take_back());
  EXPECT_TRUE(sketch.place_again());
  EXPECT_FALSE(sketch.place_again());
  EXPECT_TRUE(sketch.take_back());
  ASSERT_EQ(sketch.click({2, 0}), "");
  EXPECT_FALSE(sketch.place_again());
  ASSERT_EQ(sketch.finish(), "");
  EXPECT_EQ(drawings.all()[0]->vertices[1].lon_deg, 2);
  EXPECT_FALSE(sketch.take_back());
}

TEST(Sketch, EscapeDropsVerticesThenTheTool) {
  Drawings drawings;
  Sketch sketch(drawings);
  EXPECT_FALSE(sketch.cancel());
  sketch.choose(DrawingKind::kLine);
  ASSERT_EQ(sketch.click({0, 0}), "");
  EXPECT_TRUE(sketch.cancel());
  EXPECT_TRUE(sketch.unfinished().empty());
  EXPECT_TRUE(sketch.tool());
  EXPECT_TRUE(sketch.cancel());
  EXPECT_FALSE(sketch.tool());
  EXPECT_EQ(drawings.size(), 0U);
}

TEST(Sketch, ADragMovesTheNearestVertexAsOneStep) {
  Drawings drawings;
  Drawing line;
  line.kind = DrawingKind::kLine;
  line.vertices = {{0, 0}, {10, 0}};
  ASSERT_EQ(drawings.add(line), "");
  line.visible = false;
  ASSERT_EQ(drawings.add(line), "");
  const auto flat = [](mars::LonLat p) -> std::optional<glm::dvec2> {
    if (p.lon_deg > 50) return std::nullopt;
    return glm::dvec2{p.lon_deg, p.lat_deg};
  };
  EXPECT_FALSE(nearest_vertex(drawings.all(), flat, {5, 0}, 3));
  const auto found = nearest_vertex(drawings.all(), flat, {9, 1}, 3);
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, (VertexRef{drawings.all()[0]->id, 1}));
  Sketch sketch(drawings);
  EXPECT_NE(sketch.drag({1, 1}), "");
  sketch.press(*found);
  for (int n = 1; n < 9; ++n) ASSERT_EQ(sketch.drag({10, 1.0 * n}), "");
  EXPECT_NE(sketch.drag({180, 0}), "");  // opposite of the other end
  sketch.release();
  EXPECT_EQ(drawings.all()[0]->vertices[1].lat_deg, 8);
  EXPECT_EQ(drawings.undo_state().undo_steps, 3U);
  drawings.undo();
  EXPECT_EQ(drawings.all()[0]->vertices[1].lat_deg, 0);
  EXPECT_FALSE(sketch.held());
}

}  // namespace
}  // namespace vpe::explore
