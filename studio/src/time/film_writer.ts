// SPDX-License-Identifier: MIT
import { BufferTarget, CanvasSource, getFirstEncodableVideoCodec, Output, WebMOutputFormat } from "mediabunny";
import { t } from "../language";

/** Bits for each pixel of a picture: sharp edges and flat colours as here stay clean. */
const BITS_PER_PIXEL = 0.12;
const LEAST_BITRATE = 1e6;

/** Why this browser makes no films; null where it does. */
export async function filmHindrance(width: number, height: number): Promise<string | null> {
  if (typeof VideoEncoder === "undefined") return t("This browser cannot encode video (it has no WebCodecs, or the page is not secure). Chromium, Edge and newer Firefox and Safari can, over https or on localhost.");
  if (!(await getFirstEncodableVideoCodec(["vp9", "vp8"], { width, height }))) return t("This browser encodes neither VP9 nor VP8 in this size. Choose a smaller one.");
  return null;
}

/** A WebM film in the making: pictures of one canvas, each with its time. */
export class FilmWriter {
  private constructor(
    private readonly output: Output<WebMOutputFormat, BufferTarget>,
    private readonly source: CanvasSource,
  ) {}

  /** A film of what will be drawn on `canvas`, of about `fps` pictures a second. */
  static async open(canvas: OffscreenCanvas, fps: number): Promise<FilmWriter> {
    const { width, height } = canvas;
    const codec = await getFirstEncodableVideoCodec(["vp9", "vp8"], { width, height });
    if (!codec) throw new Error(t("This browser encodes neither VP9 nor VP8 in this size."));
    const bitrate = Math.max(LEAST_BITRATE, Math.round(BITS_PER_PIXEL * width * height * fps));
    const source = new CanvasSource(canvas, { codec, bitrate, keyFrameInterval: 2 });
    const output = new Output({ format: new WebMOutputFormat(), target: new BufferTarget() });
    output.addVideoTrack(source, { frameRate: fps });
    await output.start();
    return new FilmWriter(output, source);
  }

  /** Adds the canvas as it is now, at a time of the film and for so long, s. Resolves once there is room for the next. */
  add(time: number, duration: number): Promise<void> {
    return this.source.add(time, duration);
  }

  async finish(): Promise<Blob> {
    await this.output.finalize();
    return new Blob([this.output.target.buffer!], { type: "video/webm" });
  }

  cancel(): Promise<void> {
    return this.output.cancel();
  }
}
