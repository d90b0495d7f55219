# Makes main-table.tsv once more from the events, and says how far the two are apart.
# Needs R and nothing else: Rscript main_table.R

folder <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(), value = TRUE)[1]))

read <- function(path) {
  read.delim(path, na.strings = "n/a", colClasses = "character", check.names = FALSE, quote = "\"")
}

printed <- read(file.path(folder, "main-table.tsv"))
events <- Sys.glob(file.path(folder, "..", "sub-*", "ses-*", "beh", "*_events.tsv"))
cells <- list()
for (path in events) {
  parts <- strsplit(sub("_events.tsv$", "", basename(path)), "_")[[1]]
  names <- sub("^[a-z]+-", "", parts)
  names(names) <- sub("-.*$", "", parts)
  table <- read(path)
  # Practice, what was given up and what was not felt do not count.
  counts <- table$practice == "0" & table$aborted == "0" & (is.na(table$valid) | table$valid != "0")
  table <- table[counts, ]
  asked <- unique(printed[printed$task == names["task"], c("value", "by_column", "is_geometric")])
  for (i in seq_len(nrow(asked))) {
    value <- as.numeric(table[[asked$value[i]]])
    by <- if (asked$by_column[i] %in% colnames(table)) table[[asked$by_column[i]]] else rep("all", length(value))
    key <- paste(names["task"], asked$value[i], paste0("sub-", names["sub"]), by, sep = "\t")
    for (k in unique(key[!is.na(value)])) {
      cells[[k]] <- c(cells[[k]], value[key == k & !is.na(value)])
    }
  }
}
cat("task\tvalue\tparticipant_id\tby\tn\tmean\n")
largest <- 0
for (i in seq_len(nrow(printed))) {
  row <- printed[i, ]
  key <- paste(row$task, row$value, row$participant_id, row$by, sep = "\t")
  values <- cells[[key]]
  if (length(values) != as.integer(row$n)) stop(key, ": ", length(values), " rows, ", row$n, " were counted")
  again <- if (row$is_geometric == "1") exp(mean(log(values))) else mean(values)
  largest <- max(largest, abs(again - as.numeric(row$mean)) / max(1, abs(again)))
  cat(key, length(values), sprintf("%.12g", again), sep = "\t")
  cat("\n")
}
if (length(cells) != nrow(printed)) stop("cells are missing in main-table.tsv")
message(nrow(printed), " cells, apart by ", format(largest, digits = 2), " at most")
if (largest > 1e-9) stop("the tables differ")
