//! placeholder
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct Node8 { pub lo: [[f32; 8]; 3], pub hi: [[f32; 8]; 3], pub child: [ChildRef; 8] }
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChildRef(u32);
impl ChildRef {
    pub const EMPTY: Self = Self(7 << 29);
    pub fn node(i: u32) -> Self { Self(i) }
    pub fn leaf(kind: u8, i: u32) -> Self { Self((kind as u32) << 29 | i) }
    pub fn kind(self) -> u8 { (self.0 >> 29) as u8 }
    pub fn index(self) -> usize { (self.0 & ((1 << 29) - 1)) as usize }
    pub fn is_node(self) -> bool { self.kind() == 0 }
    pub fn is_empty(self) -> bool { self.kind() == 7 }
}
