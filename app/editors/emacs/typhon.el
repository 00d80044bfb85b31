;;; typhon.el --- Agent programs of Typhon in Emacs  -*- lexical-binding: t -*-

;; Package-Requires: ((emacs "26.1"))

;;; Commentary:

;; A minor mode for agent programs, beside `prolog-mode' or `sweeprolog-mode':
;; what agent_check/1 finds is shown by Flymake, and the words of agents have
;; colours.
;;
;;   (add-to-list 'load-path "/path/to/typhon/app/editors/emacs")
;;   (require 'typhon)
;;   (add-hook 'prolog-mode-hook #'typhon-maybe-mode)
;;
;; In a clone of Typhon:
;;
;;   (setq typhon-library "/path/to/typhon/prolog/typhon.pl")

;;; Code:

(require 'flymake)

(defgroup typhon nil
  "Agent programs of Typhon."
  :group 'languages)

(defcustom typhon-swipl "swipl"
  "The program that runs SWI-Prolog."
  :type 'string)

(defcustom typhon-library "library(typhon)"
  "The library, if the pack is installed, or the file prolog/typhon.pl."
  :type 'string)

(defconst typhon-program-regexp
  "^[ \t]*:-[ \t\n]*\\(?:agent\\|payload\\)("
  "What an agent program or a payload begins with.")

(defconst typhon-problem-regexp
  (concat "^\\(ERROR\\|Warning\\): +\\(?:\\[[^]]*\\] +\\)?"
          "\\(.+?\\):\\([0-9]+\\):\\(?:[0-9]+:\\)? +\\(.*\\)$")
  "Kind, file, line and text of what agent_check/1 prints.")

(defconst typhon-keywords
  `((,(regexp-opt '("move" "clone" "sleep" "receive" "dispose") 'symbols)
     . font-lock-keyword-face)
    (,(regexp-opt
       '("self" "here" "home" "parent" "hops" "now" "neighbours" "neighbour"
         "host_load" "create" "monitor" "unmonitor" "followers" "offer" "unoffer" "find" "send" "leave" "leave_new" "sense" "take" "attach"
         "detach" "deliver" "undeliver" "log" "result" "next_host" "emit"
         "withdraw" "pheromone" "seal" "unseal")
       'symbols)
     . font-lock-builtin-face)))

(defun typhon--quoted (text)
  "TEXT as a quoted atom of Prolog."
  (concat "'" (replace-regexp-in-string "['\\\\]" "\\\\\\&" text) "'"))

(defun typhon--goals (file)
  "Arguments of swipl that check FILE."
  (list "-q" "-g"
        (format "use_module(%s)"
                (if (string-match-p "\\`library(" typhon-library)
                    typhon-library
                  (typhon--quoted (expand-file-name typhon-library))))
        "-g" (format "agent_check(%s)" (typhon--quoted file))
        "-t" "halt"))

(defun typhon--diagnostics (output file source)
  "What is said of FILE in the buffer OUTPUT, as diagnostics of SOURCE."
  (let ((found nil))
    (with-current-buffer output
      (goto-char (point-min))
      (while (re-search-forward typhon-problem-regexp nil t)
        (let ((kind (if (equal (match-string 1) "ERROR") :error :warning))
              (place (match-string 2))
              (line (string-to-number (match-string 3)))
              (text (match-string 4)))
          (when (equal (file-truename place) (file-truename file))
            (let ((region (flymake-diag-region source line)))
              (push (flymake-make-diagnostic source (car region) (cdr region)
                                             kind text)
                    found))))))
    (nreverse found)))

(defvar-local typhon--process nil)

(defun typhon-flymake (report &rest _)
  "Check the file of this buffer, and call REPORT: a backend of Flymake.
The file is checked as it was saved."
  (when (process-live-p typhon--process)
    (delete-process typhon--process))
  (let ((source (current-buffer))
        (file (buffer-file-name))
        (output (generate-new-buffer " *typhon*")))
    (if (or (null file) (buffer-modified-p))
        (progn (kill-buffer output)
               (funcall report nil))
      (setq typhon--process
            (make-process
             :name "typhon" :buffer output :noquery t
             :connection-type 'pipe     ; else the output has colours
             :command (cons typhon-swipl (typhon--goals file))
             :sentinel
             (lambda (process _)
               (when (memq (process-status process) '(exit signal))
                 (unwind-protect
                     (when (and (buffer-live-p source)
                                (eq process
                                    (buffer-local-value 'typhon--process
                                                        source)))
                       (funcall report
                                (typhon--diagnostics output file source)))
                   (kill-buffer output)))))))))

;;;###autoload
(define-minor-mode typhon-mode
  "Agent programs of Typhon: Flymake and colours."
  :lighter " Typhon"
  (if typhon-mode
      (progn
        (font-lock-add-keywords nil typhon-keywords)
        (add-hook 'flymake-diagnostic-functions #'typhon-flymake nil t)
        (add-hook 'after-save-hook #'flymake-start nil t)
        (flymake-mode 1))
    (font-lock-remove-keywords nil typhon-keywords)
    (remove-hook 'flymake-diagnostic-functions #'typhon-flymake t)
    (remove-hook 'after-save-hook #'flymake-start t))
  (font-lock-flush))

;;;###autoload
(defun typhon-maybe-mode ()
  "Turn on `typhon-mode' if this is an agent program or a payload."
  (save-excursion
    (goto-char (point-min))
    (when (re-search-forward typhon-program-regexp nil t)
      (typhon-mode 1))))

(provide 'typhon)
;;; typhon.el ends here
