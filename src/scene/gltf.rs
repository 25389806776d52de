//! glTF 2.0 → Scene.
