//! Kernels of a test's own, around the shared shader files that it looks at.

use bytemuck::Pod;
use corpuscle::gpu::{Access, Binding, Constants, Device, Kernel, KernelSource, Recording};

/// A kernel `probe` that reads `inputs` and writes four words for each thread to `outputs`; `counters`, zero before, are there too.
pub struct Probe {
    text: String,
    variants: [Option<String>; 2],
    overrides: Vec<(&'static str, bool)>,
    constants: Vec<(&'static str, f64)>,
}

impl Probe {
    pub fn new(text: String, constants: &Constants) -> Probe {
        let overrides = constants.iter().map(|&(name, _)| (name, true)).collect();
        Probe { text, variants: [None, None], overrides, constants: constants.to_vec() }
    }

    /// With sources in the other variants.
    pub fn or(self, variants: [String; 2]) -> Probe {
        Probe { variants: variants.map(Some), ..self }
    }

    /// What it writes for so many threads in these workgroups.
    pub fn run<T: Pod>(self, device: &Device, inputs: &[T], threads: usize, groups: [u32; 3]) -> Vec<[u32; 4]> {
        self.run_and_count(device, inputs, threads, groups).0
    }

    /// The same, and the counters.
    pub fn run_and_count<T: Pod>(
        self,
        device: &Device,
        inputs: &[T],
        threads: usize,
        groups: [u32; 3],
    ) -> (Vec<[u32; 4]>, Vec<u32>) {
        // A table of kernels is static; this one is as long as the program.
        let source = Box::leak(Box::new(KernelSource {
            name: "probe",
            entry_point: "probe",
            phases: &[],
            bindings: &[
                Binding { index: 0, name: "inputs", access: Access::Read, stepped: None },
                Binding { index: 1, name: "outputs", access: Access::ReadWrite, stepped: None },
                Binding { index: 2, name: "counters", access: Access::ReadWrite, stepped: None },
            ],
            overrides: Vec::leak(self.overrides),
            source: String::leak(self.text),
            variants: self.variants.map(|variant| variant.map(|text| &*String::leak(text))),
        }));
        let inputs = device.storage_of("inputs", inputs).expect("memory");
        let outputs = device.storage::<[u32; 4]>("outputs", threads as u64).expect("memory");
        let counters = device.storage::<u32>("counters", 2048).expect("memory");
        let buffers = |name: &str| match name {
            "inputs" => Some(&inputs),
            "outputs" => Some(&outputs),
            _ => Some(&counters),
        };
        let kernel = Kernel::new(device, source, &self.constants).expect("a kernel");
        let bound = kernel.bind(device, buffers).expect("its buffers");
        let mut recording = Recording::new(device);
        bound.dispatch(&mut recording.phase("probe"), 0, groups);
        recording.submit();
        let read = device.read(&outputs, threads).expect("the device's answer");
        (read, device.read(&counters, 2048).expect("the device's answer"))
    }
}
