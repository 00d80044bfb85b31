:- module(typhon_program, []).

/** <module> Programs

Clause files are read, checked and installed here, and the machine executes
the clauses.  This layer does not know of hosts or sockets.
This is the interface of the layer: higher layers import from here.
*/

:- reexport(program/source,
            [ clause_parts/3, declaration/4, files_beside/3, indicator_in/2,
              path_below/1, program_file/2, source_clause/2, source_same/1,
              source_terms/5 ]).
:- reexport(program/libraries, [library_export/2]).
:- reexport('program/programs').
:- reexport(program/places, [place/3]).
:- reexport(program/code,
            [ code_install/3, code_receive/2, code_module/2, code_known/2,
              code_compiled/2, code_locate/2, code_names/2, code_places/2, code_program/2,
              code_sent/2, code_clear/0, code_make/3, code_extras/2,
              code_unwrapped/3, code_wrapped/3, sent_program/2 ]).
:- reexport('program/mobile').
:- reexport(program/machine,
            [answer_at/3, machine_ready/1, machine_run/3]).
:- reexport(program/thread_state, [library_hook/0, machine_inside/0]).
:- reexport(program/faults, [fault/3, fault_note/1, fault_noted/1]).
:- reexport(program/bodies,
            [body_goals/4, control/1, goals_body/2]).
:- reexport(program/chunks, [plain_goals/2]).
