//! Further pictures of the cloth, laid over the first.

use crate::tools::picture::draft::{Draft, Part};
use crate::tools::picture::found::{Correlated, Found, Laid};
use selvedge_foundation::progress::{Cancelled, Progress};
use selvedge_textile::n_threads;
use selvedge_textile::picture::{EvenLight, PictureError, Turned, TurnedPicture};

/// Whether uneven light is divided out.
pub(super) fn even(inputs: &Draft) -> EvenLight {
    if inputs.is_evened {
        EvenLight::Auto
    } else {
        EvenLight::Off
    }
}

/// Lays the further pictures over the first.
pub(super) fn turned(
    inputs: &Draft,
    correlated: &Correlated,
    progress: &mut Progress<'_>,
) -> Result<Vec<Laid>, Cancelled> {
    let mut all = Vec::new();
    for file in &inputs.turned {
        let bytes = match inputs.part {
            Part::Whole => file.bytes().map_err(str::to_owned),
            _ => Err("further pictures go with the whole picture; choose part “all”".to_owned()),
        };
        let laid = bytes.map(|bytes| {
            let other = (bytes, file.file_name());
            let (first, even) = (&correlated.luminance, even(inputs));
            Turned::read(first, other, even, n_threads(), progress)
        });
        all.push(match laid {
            Ok(Err(PictureError::Cancelled(cancelled))) => return Err(cancelled),
            Ok(laid) => laid.map_err(|error| error.to_string()),
            Err(line) => Err(line),
        });
    }
    Ok(all)
}

/// Further pictures that could be laid over the first, and as a textile names them.
pub(super) fn laid(found: &Found) -> (Vec<Turned>, Vec<TurnedPicture>) {
    let all = found.turned.iter().flat_map(|all| all.iter());
    all.flatten().cloned().unzip()
}
