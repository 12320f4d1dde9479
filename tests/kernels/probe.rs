//! Kernels of a test's own, around the shared shader files that it looks at.

use bytemuck::Pod;
use corpuscle::gpu::{Access, Binding, Constants, Device, Kernel, KernelSource, Recording};

/// A kernel `probe` that reads `inputs` and writes four words for each thread to `outputs`.
pub struct Probe {
    text: String,
    for_software: Option<String>,
    overrides: Vec<(&'static str, bool)>,
    constants: Vec<(&'static str, f64)>,
}

impl Probe {
    pub fn new(text: String, constants: &Constants) -> Probe {
        let overrides = constants.iter().map(|&(name, _)| (name, true)).collect();
        Probe { text, for_software: None, overrides, constants: constants.to_vec() }
    }

    /// With another source for software devices.
    pub fn or(self, for_software: String) -> Probe {
        Probe { for_software: Some(for_software), ..self }
    }

    /// What it writes for so many threads in these workgroups.
    pub fn run<T: Pod>(self, device: &Device, inputs: &[T], threads: usize, groups: [u32; 3]) -> Vec<[u32; 4]> {
        // A table of kernels is static; this one is as long as the program.
        let source = Box::leak(Box::new(KernelSource {
            name: "probe",
            entry_point: "probe",
            bindings: &[
                Binding { index: 0, name: "inputs", access: Access::Read },
                Binding { index: 1, name: "outputs", access: Access::ReadWrite },
            ],
            overrides: Vec::leak(self.overrides),
            source: String::leak(self.text),
            for_software: self.for_software.map(|text| &*String::leak(text)),
        }));
        let buffers = [
            device.storage_of("inputs", inputs).expect("memory"),
            device.storage::<[u32; 4]>("outputs", threads as u64).expect("memory"),
        ];
        let kernel = Kernel::of(device, source, &self.constants).expect("a kernel");
        let bound = kernel.bind(device, |name| buffers.get(usize::from(name == "outputs"))).expect("its buffers");
        let mut recording = Recording::new(device);
        bound.dispatch(recording.phase("probe"), 0, groups);
        recording.submit();
        device.read(&buffers[1], threads).expect("the device's answer")
    }
}
