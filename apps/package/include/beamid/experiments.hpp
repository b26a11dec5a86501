// From a record or an experiment file to an estimate and a report; what models, modal methods, readers,
// preparation steps and studies of one's own stand on. Component experiments.
#pragma once

#include "experiments/config/read_experiment.hpp"
#include "experiments/identify/engine/record_identification.hpp"
#include "experiments/modal/modal_method.hpp"
#include "experiments/models/estimates.hpp"
#include "experiments/models/joint_model.hpp"
#include "experiments/models/oscillator.hpp"
#include "experiments/models/springs/spring_law.hpp"
#include "experiments/record/prepare/preparation_step.hpp"
#include "experiments/record/prepare/prepared_record.hpp"
#include "experiments/record/record.hpp"
#include "experiments/record/record_table.hpp"
#include "experiments/results/result_directory.hpp"
#include "experiments/results/results.hpp"
#include "experiments/rig/simulated_test.hpp"
#include "experiments/studies/study.hpp"
