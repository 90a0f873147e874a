export { Scene, PerspectiveCamera, WebGLRenderer, Color, Group, Mesh, BufferGeometry, BufferAttribute, SphereGeometry, CylinderGeometry, InstancedMesh, Matrix4, Quaternion, Vector3, MeshStandardMaterial, HemisphereLight, DirectionalLight, SRGBColorSpace, CatmullRomCurve3 } from 'three';
export { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
