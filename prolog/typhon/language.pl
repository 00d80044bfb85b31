:- module(typhon_language,
          [ advice_text/2,              % +Advice, -Text
            declaration/4,              % +Kind, +Term, -Name, -Options
            file_parts/4,               % +Kind, +Located, -Parts, -Problems
            files_beside/3,             % +File, +Dir, -Files
            in_file_order/3,            % +Problems, +Located, -Ordered
            library_directive/2,        % +Parts, -Library
            part/3,                     % +What, +Parts, -Value
            payload_file/1,             % +File
            payload_load/2,             % +Spec, -Payload
            payload_python/3,           % +Payload, -Name, -Source
            payload_terms/3,            % +Located, -Payload, -Errors
            problem_error/3,            % +Problem, +Others, -Error
            program_file/2,             % +Spec, -File
            program_load/6,             % +Spec, -Program, -Initial, -Hash,
                                        % -Kinds, -Places
            program_read/7,             % +Spec, -Program, -Initial, -Kinds,
                                        % -Places, -Sources, -Doubtful
            program_terms/6,            % +Located, -Program, -Initial, -Kinds,
                                        % -Places, -Errors
            source_clause/2,            % +Location, -Clause
            source_same/1,              % +Sources
            source_terms/5              % +Spec, -Located, -Sources, -Errors,
                                        % -Warnings
          ]).
:- reexport('language/programs').
:- reexport(language/source,
            [ declaration/4, files_beside/3, program_file/2,
              source_clause/2, source_same/1, source_terms/5 ]).

/** <module> The language of programs

Clause files are read and checked here.  A process that creates no agent from a
program needs none of this: modules that are loaded at once import this
interface by autoload/2, which reads the names from its list of exports.

*Threading*: any thread.
*/
