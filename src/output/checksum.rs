//! Checksums of files.

use std::io::Read;

/// Of all that is left in `source`.
pub(super) fn length_and_crc(source: &mut impl Read) -> std::io::Result<(u64, u32)> {
    let mut crc = crc32fast::Hasher::new();
    let mut chunk = vec![0; 1 << 16];
    let mut bytes = 0;
    loop {
        match source.read(&mut chunk) {
            Ok(0) => return Ok((bytes, crc.finalize())),
            Ok(count) => {
                crc.update(&chunk[..count]);
                bytes += count as u64;
            }
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}
