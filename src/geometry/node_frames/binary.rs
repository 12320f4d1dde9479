//! The binary file of frames, ending `.nodes`; all little endian.
//!
//! | bytes | what |
//! |---|---|
//! | 8 | the text `CORPNODE` |
//! | u32 | version, 1 |
//! | u32 | bytes of a coordinate: 4 (f32) or 8 (f64) |
//! | u64, u64, u64 | numbers of frames F, nodes N, triangles T; T may be 0 |
//! | F f64 | times |
//! | 3 T u32 | nodes of the triangles, from 0 |
//! | 3 F N f32 or f64 | x, y, z of each node, frame by frame |
//! | u32 | CRC-32 (IEEE) of all bytes before it |

use super::error::{FrameFault, Misread};
use super::frames::NodeFrames;

const MAGIC: &[u8; 8] = b"CORPNODE";
const VERSION: u32 = 1;
const HEADER: usize = 40;
const CHECKSUM: usize = 4;

/// Of the coordinates in a `.nodes` file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// f32.
    Single,
    /// f64.
    Double,
}

impl Precision {
    pub(super) fn bytes(self) -> usize {
        match self {
            Precision::Single => 4,
            Precision::Double => 8,
        }
    }
}

/// Why bytes are no frames.
pub(super) enum Refused {
    Misread(Misread),
    Fault(FrameFault),
}

impl From<Misread> for Refused {
    fn from(misread: Misread) -> Refused {
        Refused::Misread(misread)
    }
}

pub(super) fn encoded(frames: &NodeFrames, precision: Precision) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((precision.bytes() as u32).to_le_bytes());
    for count in [frames.frame_count(), frames.node_count(), frames.triangles().len()] {
        bytes.extend((count as u64).to_le_bytes());
    }
    frames.times().iter().for_each(|time| bytes.extend(time.to_le_bytes()));
    frames.triangles().as_flattened().iter().for_each(|node| bytes.extend(node.to_le_bytes()));
    for x in frames.positions().as_flattened() {
        match precision {
            Precision::Single => bytes.extend((*x as f32).to_le_bytes()),
            Precision::Double => bytes.extend(x.to_le_bytes()),
        }
    }
    let checksum = crc32fast::hash(&bytes);
    bytes.extend(checksum.to_le_bytes());
    bytes
}

pub(super) fn decoded(bytes: &[u8]) -> Result<NodeFrames, Refused> {
    let misread = |found: String, expected: String| Misread::new("", found, expected);
    if !bytes.starts_with(MAGIC) {
        let found = String::from_utf8_lossy(&bytes[..bytes.len().min(MAGIC.len())]).escape_debug().to_string();
        return Err(misread(format!("a file that begins with `{found}`"), "`CORPNODE`".into()).into());
    }
    if bytes.len() < HEADER + CHECKSUM {
        let found = format!("{} bytes", bytes.len());
        return Err(misread(found, format!("at least {}: it is cut off", HEADER + CHECKSUM)).into());
    }
    let version = u32::from_le_bytes(at(bytes, 8));
    if version != VERSION {
        return Err(misread(format!("version {version}"), format!("version {VERSION}")).into());
    }
    let precision = match u32::from_le_bytes(at(bytes, 12)) {
        4 => Precision::Single,
        8 => Precision::Double,
        other => return Err(misread(format!("coordinates of {other} bytes"), "4 or 8".into()).into()),
    };
    let counts: [u64; 3] = [16, 24, 32].map(|offset| u64::from_le_bytes(at(bytes, offset)));
    let [frames, nodes, triangles] = counts;
    let Some(length) = length(counts, precision) else {
        let found = format!("{frames} frames of {nodes} nodes and {triangles} triangles");
        return Err(misread(found, "what a file can hold".into()).into());
    };
    if bytes.len() as u64 != length {
        let (found, told) = (bytes.len(), format!("{frames} frames of {nodes} nodes and {triangles} triangles"));
        let cut = if (found as u64) < length { ": it is cut off" } else { "" };
        return Err(misread(format!("{found} bytes"), format!("the {length} of {told}{cut}")).into());
    }
    let (content, checksum) = bytes.split_at(bytes.len() - CHECKSUM);
    let (found, expected) = (crc32fast::hash(content), u32::from_le_bytes(at(checksum, 0)));
    if found != expected {
        let expected = format!("{expected:08x}, which it ends with: it was altered");
        return Err(misread(format!("the checksum {found:08x}"), expected).into());
    }
    // All of these fit into memory, since the file does.
    let (times, rest) = content[HEADER..].split_at(8 * frames as usize);
    let (corners, positions) = rest.split_at(12 * triangles as usize);
    let times = times.chunks_exact(8).map(|b| f64::from_le_bytes(at(b, 0))).collect();
    let triangle = |b: &[u8]| [0, 4, 8].map(|k| u32::from_le_bytes(at(b, k)));
    let triangles = corners.chunks_exact(12).map(triangle).collect();
    let position = |b: &[u8]| match precision {
        Precision::Single => [0, 4, 8].map(|k| f64::from(f32::from_le_bytes(at(b, k)))),
        Precision::Double => [0, 8, 16].map(|k| f64::from_le_bytes(at(b, k))),
    };
    let positions = positions.chunks_exact(3 * precision.bytes()).map(position).collect();
    NodeFrames::of_parts(times, positions, nodes as usize, triangles).map_err(Refused::Fault)
}

/// Of the file; `None` beyond 2^64.
fn length([frames, nodes, triangles]: [u64; 3], precision: Precision) -> Option<u64> {
    let positions = frames.checked_mul(nodes)?.checked_mul(3 * precision.bytes() as u64)?;
    let head = frames.checked_mul(8)?.checked_add(triangles.checked_mul(12)?)?;
    head.checked_add(positions)?.checked_add((HEADER + CHECKSUM) as u64)
}

fn at<const N: usize>(bytes: &[u8], offset: usize) -> [u8; N] {
    std::array::from_fn(|k| bytes[offset + k])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames() -> NodeFrames {
        let frame = |t: f64| vec![[0.1 * t, 0.2, -0.3], [1.0, t, 2.0], [0.0, -7.5, 1e-9]];
        NodeFrames::new(vec![-0.5, 0.0, 1e-3], vec![frame(0.0), frame(1.0), frame(2.0)], vec![[0, 1, 2]]).unwrap()
    }

    fn refused(bytes: &[u8]) -> String {
        match decoded(bytes) {
            Ok(_) => "accepted".into(),
            Err(Refused::Fault(fault)) => fault.to_string(),
            Err(Refused::Misread(Misread { found, expected, .. })) => format!("found {found}, expected {expected}"),
        }
    }

    #[test]
    fn frames_come_back_to_the_bit() {
        let bytes = encoded(&frames(), Precision::Double);
        assert_eq!(bytes.len(), 40 + 24 + 12 + 3 * 3 * 24 + 4);
        assert!(decoded(&bytes).is_ok_and(|read| read == frames()));
        let single = encoded(&frames(), Precision::Single);
        let Ok(read) = decoded(&single) else { panic!("{}", refused(&single)) };
        assert_eq!((read.times(), read.triangles()), (frames().times(), frames().triangles()));
        assert_eq!(read.frame(1)[0], [0.1f32, 0.2, -0.3].map(f64::from));
    }

    #[test]
    fn files_that_are_no_frames_say_why() {
        let bytes = encoded(&frames(), Precision::Double);
        assert_eq!(refused(b"solid x"), "found a file that begins with `solid x`, expected `CORPNODE`");
        assert_eq!(refused(&bytes[..20]), "found 20 bytes, expected at least 44: it is cut off");
        let words = "found 295 bytes, expected the 296 of 3 frames of 3 nodes and 1 triangles: it is cut off";
        assert_eq!(refused(&bytes[..295]), words);
        let with = |offset: usize, byte: u8| {
            let mut changed = bytes.clone();
            changed[offset] = byte;
            refused(&changed)
        };
        assert_eq!(with(8, 2), "found version 2, expected version 1");
        assert_eq!(with(12, 2), "found coordinates of 2 bytes, expected 4 or 8");
        assert!(with(31, 0xff).contains("expected what a file can hold"), "{}", with(31, 0xff));
        assert!(with(100, 3).contains("which it ends with: it was altered"), "{}", with(100, 3));
    }

    /// Whatever bytes: an error, and no panic.
    #[test]
    fn no_byte_brings_it_down() {
        let bytes = encoded(&frames(), Precision::Single);
        for k in 0..bytes.len() {
            for byte in [0, 1, 0x7f, 0x80, 0xff] {
                let mut changed = bytes.clone();
                changed[k] = byte;
                assert!(changed == bytes || refused(&changed) != "accepted", "{k} {byte}");
                assert!(k == bytes.len() || refused(&bytes[..k]) != "accepted");
            }
        }
    }
}
