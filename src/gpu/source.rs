//! A kernel as text: a validated shader, its bindings, its constants, and the variants of its text.
//!
//! Who has kernels keeps them in a table of [`KernelSource`]s, which `build.rs` generates from `shaders/`.

/// How a shader uses a binding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    Uniform,
    Read,
    ReadWrite,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Binding {
    pub index: u32,
    pub name: &'static str,
    pub access: Access,
    /// Bytes that a dispatch sees, of a uniform whose offset is chosen at each dispatch.
    pub stepped: Option<u32>,
}

/// One file of `shaders/`, with the shared files it uses.
#[derive(Debug)]
pub struct KernelSource {
    pub name: &'static str,
    pub entry_point: &'static str,
    /// In which it is dispatched, by name; of one that is not in the table none.
    pub phases: &'static [&'static str],
    pub bindings: &'static [Binding],
    /// Name, and whether a value must be given.
    pub overrides: &'static [(&'static str, bool)],
    pub source: &'static str,
    /// The same in the variants behind [`KernelVariant::Plain`], where they are others.
    pub variants: [Option<&'static str>; 2],
}

impl KernelSource {
    /// A kernel of a test, without buffers.
    #[cfg(test)]
    pub(super) const fn probe(source: &'static str) -> KernelSource {
        KernelSource {
            name: "probe",
            entry_point: "probe",
            phases: &[],
            bindings: &[],
            overrides: &[],
            source,
            variants: [None; 2],
        }
    }

    pub fn text(&self, variant: KernelVariant) -> &'static str {
        let other = match variant {
            KernelVariant::Plain => None,
            KernelVariant::Software => self.variants[0],
            KernelVariant::Gpu => self.variants[1],
        };
        other.unwrap_or(self.source)
    }
}

/// The variants of kernels, which all give the same to the last bit where a driver rounds alike in each, as software devices do. A run has one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KernelVariant {
    /// For any device.
    Plain,
    /// For a software device whose subgroups are full (`shaders/shared/*.software.wgsl`).
    Software,
    /// For a GPU with subgroups (`shaders/shared/*.gpu.wgsl`).
    Gpu,
}

impl KernelVariant {
    /// What a bench calls it.
    pub fn name(self) -> &'static str {
        match self {
            KernelVariant::Plain => "plain",
            KernelVariant::Software => "software",
            KernelVariant::Gpu => "gpu",
        }
    }
}

/// A shader of pictures, with the shared files it uses: a file of `shaders/render/`, with entry points `vertex` and `fragment`.
#[derive(Debug)]
pub struct RenderSource {
    pub name: &'static str,
    pub source: &'static str,
}

/// Values of override constants by name; a kernel takes those it declares.
pub type Constants = [(&'static str, f64)];
