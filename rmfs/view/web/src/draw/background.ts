/** What stands still, drawn once and laid under every frame until it, or the camera, changes. */

import {
  type Camera,
  GLSL3,
  Mesh,
  NearestFilter,
  OrthographicCamera,
  PlaneGeometry,
  RawShaderMaterial,
  Scene,
  Vector2,
  type WebGLRenderer,
  WebGLRenderTarget,
} from "three";

const SAMPLES = 4;

const AS_IT_IS = `in vec3 position;
void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }`;

const PIXEL_BY_PIXEL = `precision mediump float;
uniform sampler2D picture;
out vec4 colour;
void main() { colour = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }`;

export class Background {
  readonly scene = new Scene();
  private readonly target: WebGLRenderTarget;
  private readonly sheet = new Scene();
  private readonly flat = new OrthographicCamera(-1, 1, 1, -1, 0, 1);
  private readonly size = new Vector2();
  private readonly seen = new Float64Array(32);
  private stale = true;

  constructor(
    private readonly renderer: WebGLRenderer,
    smooth: boolean,
  ) {
    this.target = new WebGLRenderTarget(1, 1, {
      samples: smooth ? SAMPLES : 0,
      minFilter: NearestFilter,
      magFilter: NearestFilter,
    });
    const material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: AS_IT_IS,
      fragmentShader: PIXEL_BY_PIXEL,
      uniforms: { picture: { value: this.target.texture } },
      depthTest: false,
      depthWrite: false,
    });
    const sheet = new Mesh(new PlaneGeometry(2, 2), material);
    sheet.frustumCulled = false;
    this.sheet.add(sheet);
  }

  /** Draws it anew in the next frame. */
  forget(): void {
    this.stale = true;
  }

  /** Fills the picture with what stands still, as the camera sees it. */
  draw(camera: Camera): void {
    const { renderer, target, size } = this;
    renderer.getDrawingBufferSize(size);
    if (target.width !== size.x || target.height !== size.y) {
      target.setSize(size.x, size.y);
      this.stale = true;
    }
    camera.updateMatrixWorld();
    if (this.moved(camera) || this.stale) {
      this.stale = false;
      renderer.setRenderTarget(target);
      renderer.clear();
      renderer.render(this.scene, camera);
      renderer.setRenderTarget(null);
    }
    renderer.render(this.sheet, this.flat);
  }

  private moved(camera: Camera): boolean {
    const now = [...camera.matrixWorld.elements, ...camera.projectionMatrix.elements];
    const same = now.every((value, i) => value === this.seen[i]);
    this.seen.set(now);
    return !same;
  }
}
