// The part of three.js that the 3D view uses; what is not named here is left out of the bundle.
export {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  DoubleSide,
  Group,
  LineSegments,
  Mesh,
  OrthographicCamera,
  Points,
  RGBAFormat,
  Raycaster,
  Scene,
  ShaderMaterial,
  Vector2,
  Vector3,
  Box3,
  WebGLRenderer,
} from "three";
export { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
