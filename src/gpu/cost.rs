//! What a driver says that compiled shaders cost: registers, occupancy, spills (VK_KHR_pipeline_executable_properties).

use std::ffi::CStr;

use ash::vk;

use super::device::Gpu;
use super::failed::failed;
use crate::error::Result;

/// A shader of a pipeline as it was compiled.
#[derive(Debug, Clone, PartialEq)]
pub struct Cost {
    /// By the driver's name for its stage.
    pub stage: String,
    /// Name and value, as the driver calls and counts them.
    pub statistics: Vec<(String, f64)>,
}

impl Gpu {
    /// Whether the device is open for it and the driver says what pipelines cost.
    pub fn tells_costs(&self) -> bool {
        self.statistics.is_some()
    }

    pub(super) fn pipeline_flags(&self) -> vk::PipelineCreateFlags {
        match self.tells_costs() {
            true => vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR,
            false => vk::PipelineCreateFlags::empty(),
        }
    }

    /// Of each shader of a pipeline of this device.
    pub(super) fn costs_of(&self, pipeline: vk::Pipeline) -> Result<Vec<Cost>> {
        let Some(functions) = &self.statistics else {
            return Ok(Vec::new());
        };
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the pipeline is alive and was created with its statistics; so too below.
        let shaders = unsafe { functions.get_pipeline_executable_properties(&info) }
            .map_err(failed("vkGetPipelineExecutablePropertiesKHR"))?;
        let cost = |(index, shader): (u32, &vk::PipelineExecutablePropertiesKHR)| {
            let info = vk::PipelineExecutableInfoKHR::default()
                .pipeline(pipeline)
                .executable_index(index);
            let told = unsafe { functions.get_pipeline_executable_statistics(&info) }
                .map_err(failed("vkGetPipelineExecutableStatisticsKHR"))?;
            Ok(Cost {
                stage: text(shader.name_as_c_str().ok()),
                statistics: told.iter().map(statistic).collect(),
            })
        };
        (0..).zip(&shaders).map(cost).collect()
    }
}

fn text(name: Option<&CStr>) -> String {
    name.unwrap_or_default().to_string_lossy().into_owned()
}

fn statistic(told: &vk::PipelineExecutableStatisticKHR) -> (String, f64) {
    use vk::PipelineExecutableStatisticFormatKHR as Format;
    // SAFETY: the format says which of them it is.
    let value = unsafe {
        match told.format {
            Format::BOOL32 => f64::from(told.value.b32),
            Format::INT64 => told.value.i64 as f64,
            Format::UINT64 => told.value.u64 as f64,
            _ => told.value.f64,
        }
    };
    (text(told.name_as_c_str().ok()), value)
}
