// SPDX-License-Identifier: MIT
import { Quaternion, Vector3 } from "three";
import { POSE_FLOATS, type Frame } from "../connection/frame";
import { blend } from "./blend";

/** The simulation's state of a body; the numbers are the protocol's. */
export enum BodyState {
  active = 0,
  wantsToSleep = 1,
  asleep = 2,
  still = 3,
}

interface Track {
  fromPosition: Vector3;
  fromRotation: Quaternion;
  toPosition: Vector3;
  toRotation: Quaternion;
  /** Milliseconds on the page's clock. */
  start: number;
  duration: number;
  state: BodyState;
}

/**
 * The present pose of every entity. It moves to a frame's pose during the time since the frame before, so that motion is smooth at
 * any frame rate; while the simulation does not play, poses change at once.
 */
export class Motion {
  /** Entities whose drawn pose is out of date. */
  readonly moved = new Set<number>();
  /** Entities whose state changed. */
  readonly restated = new Set<number>();
  private readonly tracks = new Map<number, Track>();
  private readonly blending = new Set<number>();
  private lastFrame = 0;

  clear(): void {
    this.tracks.clear();
    this.blending.clear();
    this.moved.clear();
    this.restated.clear();
  }

  forget(index: number): void {
    this.tracks.delete(index);
    this.blending.delete(index);
  }

  /** Sets an entity's pose at once. */
  place(index: number, position: readonly number[], rotation: readonly number[]): void {
    const track = this.track(index);
    track.toPosition.fromArray(position);
    track.toRotation.fromArray(rotation).normalize();
    track.fromPosition.copy(track.toPosition);
    track.fromRotation.copy(track.toRotation);
    this.blending.delete(index);
    this.moved.add(index);
  }

  take(frame: Frame, now: number, smooth: boolean): void {
    const duration = smooth ? Math.min(now - this.lastFrame, blend.longest) : 0;
    this.lastFrame = now;
    for (let record = 0; record < frame.indices.length; ++record) {
      const index = frame.indices[record]!;
      const known = this.tracks.has(index);
      const track = this.track(index);
      const at = record * POSE_FLOATS;
      this.blend(track, now, track.fromPosition, track.fromRotation);
      track.toPosition.fromArray(frame.poses, at);
      track.toRotation.fromArray(frame.poses, at + 3).normalize();
      track.start = now;
      track.duration = known ? duration : 0;
      this.blending.add(index);
      const state = frame.states[record]! as BodyState;
      if (track.state !== state) this.restated.add(index);
      track.state = state;
    }
  }

  /** Marks entities that are still moving to their pose as moved; returns whether any still is afterwards. */
  advance(now: number): boolean {
    for (const index of this.blending) {
      this.moved.add(index);
      const track = this.tracks.get(index)!;
      if (now >= track.start + track.duration) this.blending.delete(index);
    }
    return this.blending.size > 0;
  }

  /** The pose to draw now; false for an entity without a pose. */
  pose(index: number, now: number, position: Vector3, rotation: Quaternion): boolean {
    const track = this.tracks.get(index);
    if (!track) return false;
    this.blend(track, now, position, rotation);
    return true;
  }

  state(index: number): BodyState {
    return this.tracks.get(index)?.state ?? BodyState.still;
  }

  private blend(track: Track, now: number, position: Vector3, rotation: Quaternion): void {
    const part = track.duration > 0 ? Math.min((now - track.start) / track.duration, 1) : 1;
    position.lerpVectors(track.fromPosition, track.toPosition, part);
    rotation.slerpQuaternions(track.fromRotation, track.toRotation, part);
  }

  private track(index: number): Track {
    let track = this.tracks.get(index);
    if (!track) {
      track = {
        fromPosition: new Vector3(),
        fromRotation: new Quaternion(),
        toPosition: new Vector3(),
        toRotation: new Quaternion(),
        start: 0,
        duration: 0,
        state: BodyState.still,
      };
      this.tracks.set(index, track);
    }
    return track;
  }
}
