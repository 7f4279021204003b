// Sessions over a small planet.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "tests/paging/planet_fixture.h"
#include "vpe/explore/session.h"

namespace test_support {

inline std::shared_ptr<const paging::Surface> session_surface() {
  static const TempDir folder;
  static const auto planet = build_fake(folder / "p.vpe", FakeElevation(bumpy_height), 200'000);
  static const auto made = std::make_shared<const paging::Surface>(planet, std::size_t{32} << 20);
  return made;
}

inline vpe::explore::Session session_at(const mars::Pose& pose) {
  vpe::explore::SessionOptions options;
  options.start = pose;
  vpe::explore::Session session(session_surface(), options);
  session.resize(1280, 720);
  return session;
}

// Advances until nothing moves without input.
inline void finish(vpe::explore::Session& session, const mars::HeadAngles& head = {}) {
  for (int n = 0; n < 1000 && (session.is_going() || session.is_moving()); ++n) session.advance(0.02, {}, head);
  EXPECT_FALSE(session.is_going() || session.is_moving());
}

}  // namespace test_support
