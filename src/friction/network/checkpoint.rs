//! A network in the middle of learning as bytes: parts, each with its length before it.

use burn::module::Module;
use burn::optim::ModuleOptimizer;
use burn::tensor::Bytes;

use crate::FrictionError;

/// A part of a checkpoint: its length, its bytes.
pub(super) fn put(bytes: &mut Vec<u8>, part: &[u8]) {
    bytes.extend((part.len() as u64).to_le_bytes());
    bytes.extend(part);
}

pub(super) fn save<M: Module>(bytes: &mut Vec<u8>, module: &M, optimizer: &ModuleOptimizer) {
    // Records are made in memory: nothing can fail but what resuming would find.
    let part = |record: Result<Bytes, _>| {
        record.map_or_else(
            |_: burn::store::RecordError| Vec::new(),
            |bytes| bytes.to_vec(),
        )
    };
    put(bytes, &part(module.clone().into_record().into_bytes()));
    put(bytes, &part(optimizer.into_bytes()));
}

/// Parts of a checkpoint that are still to come.
pub(super) struct Parts<'a>(pub(super) &'a [u8]);

impl<'a> Parts<'a> {
    pub(super) fn wrong(what: impl std::fmt::Display) -> FrictionError {
        FrictionError::Checkpoint {
            what: what.to_string(),
        }
    }

    pub(super) fn next(&mut self) -> Result<&'a [u8], FrictionError> {
        let cut = || Self::wrong("it is cut short");
        let (head, rest) = self.0.split_first_chunk::<8>().ok_or_else(cut)?;
        let length = usize::try_from(u64::from_le_bytes(*head)).map_err(Self::wrong)?;
        let (part, rest) = rest.split_at_checked(length).ok_or_else(cut)?;
        self.0 = rest;
        Ok(part)
    }

    pub(super) fn restore<M: Module>(
        &mut self,
        module: &mut M,
        optimizer: &mut ModuleOptimizer,
    ) -> Result<(), FrictionError> {
        let bytes = |part: &[u8]| Bytes::from_bytes_vec(part.to_vec());
        let record =
            burn::store::ModuleRecord::from_bytes(bytes(self.next()?)).map_err(Self::wrong)?;
        *module = module.clone().load_record(record);
        let state = self.next()?;
        *optimizer = optimizer
            .clone()
            .from_bytes(bytes(state))
            .map_err(Self::wrong)?;
        Ok(())
    }
}
