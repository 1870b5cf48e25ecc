//! Nodes, skins, and the tree that they make.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3, Mat4};

/// A place in the tree of a shot, with what is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Unique in the file. It is the name in the file, or `Node.3` (by index) if there is none, or `Cube.001` for the
    /// second `Cube`.
    pub name: String,
    /// The name in the file.
    pub original_name: Option<String>,
    /// The node that it moves with.
    pub parent: Option<usize>,
    /// The nodes that move with it.
    pub children: Vec<usize>,
    /// Index into the meshes.
    pub mesh: Option<usize>,
    /// Index into the cameras.
    pub camera: Option<usize>,
    /// Index into the lights.
    pub light: Option<usize>,
    /// Index into the skins. With a skin, the mesh stands where the joints put it, and the node's own place means
    /// nothing for it.
    pub skin: Option<usize>,
    /// Weights of the mesh's morph targets, one for each. `None`: the mesh's own weights apply.
    pub weights: Option<Vec<f32>>,
    /// Whether the node and the nodes below it show (KHR_node_visibility).
    pub is_visible: bool,
    /// Where it stands, when no animation says otherwise.
    pub local: LocalTransform,
    /// Where copies of its mesh stand, in the space of the node (EXT_mesh_gpu_instancing). `None`: its mesh stands
    /// once, at the node.
    pub instances: Option<Arc<Vec<Trs>>>,
}

/// From the space of a node to that of its parent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocalTransform {
    /// Parts that can be animated.
    Trs(Trs),
    /// A matrix that has no such parts, because it has shear or flattens an axis.
    Matrix(DAffine3),
}

/// A transform in parts. Points are scaled, then turned, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trs {
    /// How far points are moved, in the parent's space.
    pub translation: DVec3,
    /// How points are turned; of unit length.
    pub rotation: DQuat,
    /// Factors along the node's own axes; may be negative or zero.
    pub scale: DVec3,
}

impl Trs {
    /// Changes nothing.
    pub const IDENTITY: Self =
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE };

    /// As a matrix.
    pub fn parent_from_local(&self) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(self.scale, self.rotation, self.translation)
    }
}

impl LocalTransform {
    /// As a matrix.
    pub fn parent_from_local(&self) -> DAffine3 {
        match self {
            Self::Trs(trs) => trs.parent_from_local(),
            Self::Matrix(matrix) => *matrix,
        }
    }

    /// A matrix as translation, rotation and scale, if these reproduce it to a millionth; else the matrix.
    pub fn of_matrix(matrix: DAffine3) -> Self {
        let axes = matrix.matrix3;
        let mut scale = DVec3::new(axes.x_axis.length(), axes.y_axis.length(), axes.z_axis.length());
        if !(scale.min_element() > 0.0 && scale.is_finite()) {
            return Self::Matrix(matrix);
        }
        if axes.determinant() < 0.0 {
            scale.x = -scale.x;
        }
        let turned = DMat3::from_cols(axes.x_axis / scale.x, axes.y_axis / scale.y, axes.z_axis / scale.z);
        let rotation = DQuat::from_mat3(&turned).normalize();
        let again = DMat3::from_quat(rotation) * DMat3::from_diagonal(scale);
        let tolerance = 1e-6 * scale.abs().max_element();
        let is_exact = rotation.is_finite() && again.abs_diff_eq(axes, tolerance);
        if is_exact {
            Self::Trs(Trs { translation: matrix.translation, rotation, scale })
        } else {
            Self::Matrix(matrix)
        }
    }
}

/// Joints that move the vertices of meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// The name in the file; empty for none.
    pub name: String,
    /// Node of each joint. At least one.
    pub joints: Vec<usize>,
    /// From the space of the mesh to that of each joint, as both were when the mesh was bound: one per joint, finite.
    pub inverse_bind_matrices: Vec<Mat4>,
    /// The node that is the root of the joints, where it is stated.
    pub skeleton: Option<usize>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_without_shear_have_parts() {
        let trs = Trs {
            translation: DVec3::new(1.0, 2.0, 3.0),
            rotation: DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 2.5),
            scale: DVec3::new(0.5, 2.0, 3.0),
        };
        let LocalTransform::Trs(parts) = LocalTransform::of_matrix(trs.parent_from_local()) else {
            panic!("it has no shear")
        };
        assert!(parts.scale.abs_diff_eq(trs.scale, 1e-12));
        assert!(parts.rotation.dot(trs.rotation).abs() > 1.0 - 1e-12);
        let mirrored = Trs { scale: DVec3::new(1.0, 1.0, -2.0), ..trs }.parent_from_local();
        let LocalTransform::Trs(parts) = LocalTransform::of_matrix(mirrored) else {
            panic!("it has no shear")
        };
        assert!(parts.parent_from_local().abs_diff_eq(mirrored, 1e-12));
    }

    #[test]
    fn shear_and_flat_matrices_stay() {
        let shear = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::new(0.5, 1.0, 0.0), DVec3::Z));
        assert_eq!(LocalTransform::of_matrix(shear), LocalTransform::Matrix(shear));
        let flat = DAffine3::from_scale(DVec3::new(1.0, 0.0, 1.0));
        assert_eq!(LocalTransform::of_matrix(flat), LocalTransform::Matrix(flat));
    }
}
