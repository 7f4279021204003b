// How finely the picture is drawn while the view moves: at full size, or with half as many pixels a side where full
// size takes too long. A view at rest is always drawn at full size. No DOM.
(function (vpe) {
  'use strict';

  const kSlow_ms = 25;
  const kRest_ms = 150;
  // Longer ones are pauses: the page was hidden, or the machine slept.
  const kPause_ms = 1000;
  const kFrames = 6;
  const kFramesAgain = 2;
  const kRemember_ms = 10000;
  // The first frames of another size include the change itself.
  const kSkipped = 2;
  const kTrial = 10;
  const kGain = 0.85;
  const kGiveUp_ms = 60000;

  // Returns the middle one of some numbers, the lower one of two.
  function median(numbers) {
    const sorted = [...numbers].sort((a, b) => a - b);
    return sorted[Math.floor((sorted.length - 1) / 2)];
  }

  // Decides from the times between frames. All times are in milliseconds, those of requestAnimationFrame().
  class Pace {
    constructor() {
      this.divisor = 1;
      this.began = null;
      this.movedAt = -Infinity;
      this.spacings = [];
      this.before = 0;
      this.isProven = false;
      this.quickUntil = -Infinity;
      this.pausedUntil = -Infinity;
    }

    // Takes the time of a frame, before it is drawn. `isMoved`: the view is another one than in the last drawing.
    begin(time, isMoved) {
      if (this.began !== null) this.measure(time, time - this.began);
      this.began = null;
      if (isMoved) {
        this.movedAt = time;
      } else if (time - this.movedAt >= kRest_ms) {
        this.divisor = 1;
        this.spacings = [];
      }
    }

    // Tells that a view that moved was drawn at a time: the next frame shows how long that took.
    drawn(time) {
      this.began = time;
    }

    measure(time, spacing) {
      if (spacing > kPause_ms) return;
      this.spacings = [...this.spacings, spacing].slice(-(kSkipped + kTrial));
      if (this.divisor === 1) this.judgeFull(time);
      else this.judgeHalf(time);
    }

    judgeFull(time) {
      const count = time < this.quickUntil ? kFramesAgain : kFrames;
      if (this.spacings.length < count || time < this.pausedUntil) return;
      this.before = median(this.spacings.slice(-count));
      if (this.before <= kSlow_ms) return;
      this.divisor = 2;
      this.isProven = false;
      this.spacings = [];
    }

    // Where half the size is hardly faster, as on displays of 30 Hz, the picture stays sharp.
    judgeHalf(time) {
      this.quickUntil = time + kRemember_ms;
      if (this.isProven || this.spacings.length < kSkipped + kTrial) return;
      this.isProven = true;
      if (median(this.spacings.slice(kSkipped)) <= kGain * this.before) return;
      this.divisor = 1;
      this.spacings = [];
      this.pausedUntil = time + kGiveUp_ms;
    }
  }

  vpe.pace = {Pace, kSlow_ms, kRest_ms, kFrames};
})((globalThis.vpe = globalThis.vpe || {}));
